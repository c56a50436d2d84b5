// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution at any set of positions ([`convolve`]): the inputs are gathered into panels,
//! which are multiplied with the weights. Those are stored in the order in which the inner loop
//! reads them ([`PackedWeights`]).

use super::blocking::BlockSizes;
use super::chunks::{CHUNK_POSITIONS, PositionChunk};
use super::gathered_inputs::{ConvInput, GatheredInputs};
use super::micro_kernel::multiply;
use crate::activation::Activation;
use foveate_pixels::vectors::{InstructionSet, PanelTask};
use std::ops::Range;

/// The number of inputs of an output that are gathered and multiplied before the next ones are
/// gathered. The inputs of a panel then stay in the nearest cache.
const GATHERED_INPUTS: usize = 288;
/// The number of panels that share a pass over the weights.
const PANELS_PER_PASS: usize = 6;

/// The number of positions that are computed for some chunks. Panels are computed as a whole.
pub(crate) fn scheduled_positions(chunks: usize, blocking: BlockSizes) -> usize {
    (chunks * CHUNK_POSITIONS).next_multiple_of(blocking.values)
}

/// Neighboring positions of some channels of the outputs.
pub(crate) struct ConvOutputs<'a, T = f32> {
    /// The values of these positions, by channel.
    pub(crate) channels: Vec<&'a mut [T]>,
    /// The memory index of the first of these positions.
    pub(crate) first_position: usize,
    /// The blocks of these channels.
    pub(crate) blocks: &'a [Range<usize>],
    /// The positions of a row.
    pub(crate) width: usize,
}

/// Computes the channels of `outputs` at the chunks, whose positions `outputs` holds. The
/// activation is applied to every output.
pub(crate) fn convolve(
    level: InstructionSet,
    picture: &ConvInput<'_>,
    weights: &PackedWeights,
    chunks: &[PositionChunk],
    outputs: ConvOutputs<'_>,
    activation: Activation,
) {
    level.run_panels(ConvTask { picture, weights, chunks, outputs, activation });
}

struct ConvTask<'a> {
    picture: &'a ConvInput<'a>,
    weights: &'a PackedWeights,
    chunks: &'a [PositionChunk],
    outputs: ConvOutputs<'a>,
    activation: Activation,
}

impl PanelTask for ConvTask<'_> {
    #[inline(always)]
    fn run<const VALUES: usize, const FUSED: bool>(self) {
        let Self { picture, weights, chunks, mut outputs, activation } = self;
        assert_eq!(weights.blocking().values, VALUES, "weights are packed for the level");
        let blocks = outputs.blocks;
        let (Some(first), Some(last)) = (blocks.first(), blocks.last()) else { return };
        let (first, channels) = (first.start, last.end - first.start);
        let taps = picture.columns.kernel;
        let all_rows = weights.depth() / taps;
        let rows_at_once = all_rows.min((GATHERED_INPUTS / taps).max(1));
        let mut gathered = GatheredInputs::new(
            picture.columns,
            PANELS_PER_PASS * VALUES / CHUNK_POSITIONS,
            rows_at_once,
        );
        // If one gather covers all products, a sum needs room only within its block.
        let is_once = rows_at_once == all_rows;
        let largest = blocks.iter().map(Range::len).max().unwrap_or_default();
        let stride = if is_once { largest } else { channels };
        let mut sums = vec![[0.0; VALUES]; stride * PANELS_PER_PASS];
        for group in chunks.chunks(PANELS_PER_PASS * VALUES / CHUNK_POSITIONS) {
            gathered.select_chunks(group);
            for from in (0..all_rows).step_by(rows_at_once) {
                let rows = from..all_rows.min(from + rows_at_once);
                gathered.gather(picture, &rows);
                for block in blocks {
                    let products =
                        weights.block_weights(block, &(rows.start * taps..rows.end * taps));
                    let first_sum = if is_once { 0 } else { block.start - first };
                    let panels =
                        sums.chunks_mut(stride).zip(group.chunks(VALUES / CHUNK_POSITIONS));
                    for (panel, (sums, chunks)) in panels.enumerate() {
                        let sums = &mut sums[first_sum..][..block.len()];
                        if from == 0 {
                            start_with_bias(sums, weights, block.start);
                        }
                        add_block::<VALUES, FUSED>(products, &gathered, panel, sums);
                        if rows.end == all_rows {
                            // All values are computed, though some may have no position.
                            activation.apply_to_all(sums.as_flattened_mut());
                            outputs.scatter(sums, block.start - first, chunks);
                        }
                    }
                }
            }
        }
    }
}

/// Starts every sum with the bias of its channel.
#[inline(always)]
fn start_with_bias<const VALUES: usize>(
    sums: &mut [[f32; VALUES]],
    weights: &PackedWeights,
    first: usize,
) {
    for (sums, channel) in sums.iter_mut().zip(first..) {
        *sums = [weights.bias(channel); VALUES];
    }
}

/// Adds the products of a block.
#[inline(always)]
pub(super) fn add_block<const VALUES: usize, const FUSED: bool>(
    weights: &[f32],
    inputs: &GatheredInputs,
    panel: usize,
    sums: &mut [[f32; VALUES]],
) {
    match (VALUES, sums.len()) {
        (32, 12) => add_sized_block::<VALUES, 12, FUSED>(weights, inputs, panel, sums),
        (32, 10) => add_sized_block::<VALUES, 10, FUSED>(weights, inputs, panel, sums),
        (16 | 32, 6) => add_sized_block::<VALUES, 6, FUSED>(weights, inputs, panel, sums),
        _ => add_sized_block::<VALUES, 4, FUSED>(weights, inputs, panel, sums),
    }
}

/// Adds the products of a block of `CHANNELS` channels.
#[inline(always)]
fn add_sized_block<const VALUES: usize, const CHANNELS: usize, const FUSED: bool>(
    weights: &[f32],
    inputs: &GatheredInputs,
    panel: usize,
    sums: &mut [[f32; VALUES]],
) {
    let sums = sums.try_into().expect("a block has a sum for each of its channels");
    let weights = weights.as_chunks().0;
    let places =
        &inputs.chunk_offsets[panel * VALUES / CHUNK_POSITIONS..][..VALUES / CHUNK_POSITIONS];
    if places.windows(2).all(|pair| pair[0] + CHUNK_POSITIONS == pair[1]) {
        multiply::<CHANNELS, VALUES, true, FUSED>(weights, inputs, places, sums);
    } else {
        multiply::<CHANNELS, VALUES, false, FUSED>(weights, inputs, places, sums);
    }
}

impl ConvOutputs<'_> {
    /// Writes the outputs of some channels to their positions.
    #[inline(always)]
    fn scatter<const VALUES: usize>(
        &mut self,
        outputs: &[[f32; VALUES]],
        first: usize,
        chunks: &[PositionChunk],
    ) {
        let place =
            |chunk: &PositionChunk| chunk.memory_range(self.width).start - self.first_position;
        let is_row =
            chunks.windows(2).all(|pair| place(&pair[0]) + CHUNK_POSITIONS == place(&pair[1]));
        let is_whole =
            is_row && chunks.len() * CHUNK_POSITIONS == VALUES && self.width >= CHUNK_POSITIONS;
        for (outputs, plane) in outputs.iter().zip(&mut self.channels[first..]) {
            if is_whole {
                let to = plane[place(&chunks[0])..].first_chunk_mut();
                *to.expect("chunks are inside") = *outputs;
                continue;
            }
            for (outputs, chunk) in outputs.as_chunks::<CHUNK_POSITIONS>().0.iter().zip(chunks) {
                let to = &mut plane[place(chunk)..];
                match to.first_chunk_mut() {
                    Some(to) if self.width >= CHUNK_POSITIONS => *to = *outputs,
                    _ => to[..self.width].copy_from_slice(&outputs[..self.width]),
                }
            }
        }
    }
}

/// The weights of a group of output channels, block by block. A block holds one weight per channel
/// for the first input, then for the second, and so on. Channels that only fill the last block have
/// weights of 0.
#[derive(Clone, Debug)]
pub(crate) struct PackedWeights<T = f32> {
    blocking: BlockSizes,
    blocks: Vec<Range<usize>>,
    /// The number of products of an output.
    depth: usize,
    packed: Vec<T>,
    bias: Vec<T>,
}

impl<T: Copy + Default> PackedWeights<T> {
    /// Packs a row of `depth` weights per channel.
    pub(crate) fn new(rows: &[T], depth: usize, bias: &[T], blocking: BlockSizes) -> Self {
        let channels = rows.len() / depth;
        let blocks = blocking.blocks(channels);
        let mut packed = Vec::with_capacity(rows.len());
        for block in &blocks {
            for input in 0..depth {
                packed.extend(
                    block.clone().map(|channel| {
                        rows.get(channel * depth + input).copied().unwrap_or_default()
                    }),
                );
            }
        }
        Self { blocking, blocks, depth, packed, bias: bias.to_vec() }
    }

    pub(crate) fn blocking(&self) -> BlockSizes {
        self.blocking
    }

    pub(crate) fn depth(&self) -> usize {
        self.depth
    }

    /// The ranges of channels of all blocks.
    pub(crate) fn blocks(&self) -> &[Range<usize>] {
        &self.blocks
    }

    /// The weights of a block for some inputs.
    pub(super) fn block_weights(&self, block: &Range<usize>, inputs: &Range<usize>) -> &[T] {
        let start = block.start * self.depth;
        &self.packed[start + inputs.start * block.len()..start + inputs.end * block.len()]
    }

    /// The bias of a channel, or 0 if there is none.
    pub(super) fn bias(&self, channel: usize) -> T {
        self.bias.get(channel).copied().unwrap_or_default()
    }
}
