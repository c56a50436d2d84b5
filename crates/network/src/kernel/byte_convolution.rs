// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution of 8-bit values with exact sums, in the loops of the floating-point convolution.
//!
//! The product of two differences of 8-bit values is at most 255 x 255, so a sum of
//! [`MAX_EXACT_PRODUCTS`] of them is below 2^24. A 32-bit floating-point value holds every integer
//! up to 2^24. The floating-point loops, which are the fastest, therefore make exact sums of so
//! many products in any order. These sums are then added as 32-bit integers.

use super::blocking::BlockSizes;
use super::chunks::{CHUNK_POSITIONS, PositionChunk};
use super::gathered_inputs::{ConvInput, GatheredInputs};
use super::panels::{ConvOutputs, PackedWeights, add_block};
use crate::values::{ByteNumber, TensorNumber};
use foveate_pixels::vectors::{InstructionSet, PanelTask, VectorTask};
use std::ops::Range;

/// The number of products whose sum is exact. A row of the window must not have more.
pub(crate) const MAX_EXACT_PRODUCTS: usize = 256;
/// The number of panels that share a pass over the weights.
const BYTE_PANELS_PER_PASS: usize = 3;
const MAX_BLOCK_CHANNELS: usize = 12;

/// The packed weights of a group of channels. Unsigned weights and their zero points are stored
/// less 128.
#[derive(Clone, Debug)]
pub(crate) struct PackedByteWeights {
    packed: PackedWeights<i8>,
    /// One zero point per channel.
    zero_points: Vec<f32>,
}

impl PackedByteWeights {
    /// Packs a row of `depth` weights per channel.
    pub(crate) fn new(rows: &[i8], depth: usize, zeros: &[i8], blocking: BlockSizes) -> Self {
        let packed = PackedWeights::new(rows, depth, &[], blocking);
        let zeros = zeros.iter().copied().map(f32::from).collect();
        Self { packed, zero_points: zeros }
    }

    pub(crate) fn packed(&self) -> &PackedWeights<i8> {
        &self.packed
    }

    /// Writes the weights of a block for some inputs to `to` as floating-point values, less their
    /// zero points.
    #[inline(always)]
    fn widen<'a>(
        &self,
        block: &Range<usize>,
        inputs: &Range<usize>,
        to: &'a mut [f32],
    ) -> &'a [f32] {
        let packed = self.packed.block_weights(block, inputs);
        let mut zeros = [0.0; MAX_BLOCK_CHANNELS];
        for (to, channel) in zeros.iter_mut().zip(block.clone()) {
            *to = self.zero_points.get(channel).copied().unwrap_or_default();
        }
        let rows = to.chunks_exact_mut(block.len()).zip(packed.chunks_exact(block.len()));
        for (to, weights) in rows {
            for ((to, &weight), zero) in to.iter_mut().zip(weights).zip(zeros) {
                *to = f32::from(weight) - zero;
            }
        }
        &to[..packed.len()]
    }
}

/// Computes the channels of `outputs` at the chunks, whose positions `outputs` holds. The padding
/// of `picture` is the zero point of the input. `finish` makes an output from its channel and its
/// sum.
pub(crate) fn convolve_bytes<X: ByteNumber, Y: TensorNumber>(
    level: InstructionSet,
    picture: &ConvInput<'_, X>,
    weights: &PackedByteWeights,
    chunks: &[PositionChunk],
    outputs: ConvOutputs<'_, Y>,
    finish: impl Fn(usize, i32) -> Y,
) {
    let ConvOutputs { channels: mut planes, first_position, blocks, width } = outputs;
    let (Some(first), Some(last)) = (blocks.first(), blocks.last()) else { return };
    let (first, stride) = (first.start, last.end - first.start);
    let taps = picture.columns.kernel;
    let rows = weights.packed.depth() / taps;
    let rows_at_once = rows.min(MAX_EXACT_PRODUCTS / taps);
    let values = weights.packed.blocking().values;
    let room = (picture.columns, BYTE_PANELS_PER_PASS * values / CHUNK_POSITIONS, rows_at_once);
    let mut gathered = GatheredInputs::new(room.0, room.1, room.2);
    let mut wide = GatheredInputs::new(room.0, room.1, room.2);
    let mut products = vec![0.0; rows_at_once * taps * MAX_BLOCK_CHANNELS];
    let mut sums = vec![0i32; stride * BYTE_PANELS_PER_PASS * values];
    for chunks in chunks.chunks(BYTE_PANELS_PER_PASS * values / CHUNK_POSITIONS) {
        let panels = chunks.len().div_ceil(values / CHUNK_POSITIONS);
        sums.fill(0);
        gathered.select_chunks(chunks);
        wide.select_chunks(chunks);
        for from in (0..rows).step_by(rows_at_once) {
            let rows = from..rows.min(from + rows_at_once);
            let inputs = rows.start * taps..rows.end * taps;
            let (gathered, wide) = (&mut gathered, &mut wide);
            level.run(GatherTask { picture, rows, gathered, wide });
            let (products, sums) = (&mut products, &mut sums);
            level.run_panels(MultiplyTask {
                weights,
                blocks,
                inputs,
                wide,
                panels,
                products,
                sums,
                stride,
            });
        }
        // The sums of a panel are finished and written channel by channel, each to the positions of
        // the panel's chunks.
        for (sums, chunks) in
            sums.chunks(stride * values).zip(chunks.chunks(values / CHUNK_POSITIONS))
        {
            for ((channel, sums), plane) in (first..).zip(sums.chunks(values)).zip(&mut planes) {
                for (sums, chunk) in sums.chunks(CHUNK_POSITIONS).zip(chunks) {
                    let range = chunk.memory_range(width);
                    let to = &mut plane[range.start - first_position..range.end - first_position];
                    for (output, &sum) in to.iter_mut().zip(sums) {
                        *output = finish(channel, sum);
                    }
                }
            }
        }
    }
}

/// Gathers rows of the window, and subtracts the zero point of the inputs.
struct GatherTask<'a, X> {
    picture: &'a ConvInput<'a, X>,
    rows: Range<usize>,
    gathered: &'a mut GatheredInputs<X>,
    wide: &'a mut GatheredInputs,
}

impl<X: ByteNumber> VectorTask for GatherTask<'_, X> {
    #[inline(always)]
    fn run(self) {
        let Self { picture, rows, gathered, wide } = self;
        let zero: f32 = picture.padding.into();
        gathered.gather(picture, &rows);
        let values = gathered.pitch * rows.len();
        for (wide, &input) in wide.window_rows[..values].iter_mut().zip(&gathered.window_rows) {
            let input: f32 = input.into();
            *wide = input - zero;
        }
    }
}

/// Adds the products of some inputs to the sums of all panels, each of which has `stride` channels.
/// This takes most of the time. The task is compiled once, because it depends neither on the type
/// of the inputs nor on that of the outputs.
struct MultiplyTask<'a> {
    weights: &'a PackedByteWeights,
    blocks: &'a [Range<usize>],
    inputs: Range<usize>,
    wide: &'a GatheredInputs,
    panels: usize,
    /// Room for the widened weights of a block.
    products: &'a mut [f32],
    /// The sums: in each panel a row of values per channel.
    sums: &'a mut [i32],
    stride: usize,
}

impl PanelTask for MultiplyTask<'_> {
    #[inline(always)]
    fn run<const VALUES: usize, const FUSED: bool>(self) {
        let Self { weights, blocks, inputs, wide, panels, products, sums, stride } = self;
        let sums = sums.as_chunks_mut::<VALUES>().0;
        let first = blocks.first().map_or(0, |block| block.start);
        for block in blocks {
            let products = weights.widen(block, &inputs, products);
            for panel in 0..panels {
                let mut exact = [[0.0; VALUES]; MAX_BLOCK_CHANNELS];
                let exact = &mut exact[..block.len()];
                add_block::<VALUES, FUSED>(products, wide, panel, exact);
                let sums = &mut sums[panel * stride + block.start - first..];
                for (sums, exact) in sums.iter_mut().zip(exact) {
                    for value in 0..VALUES {
                        #[allow(clippy::cast_possible_truncation, reason = "an integer")]
                        let exact = exact[value] as i32;
                        sums[value] = sums[value].wrapping_add(exact);
                    }
                }
            }
        }
    }
}

/// The depthwise convolution of one channel at the chunks.
pub(crate) struct DepthwiseByteTask<'a, X> {
    /// The input, whose padding is its zero point.
    pub(crate) picture: ConvInput<'a, X>,
    /// The weights of the kernel in row-major order, with their zero point.
    pub(crate) weights: (&'a [i8], i8),
    pub(crate) chunks: &'a [PositionChunk],
    /// The sums, one array for each chunk.
    pub(crate) sums: &'a mut [[i32; CHUNK_POSITIONS]],
}

impl<X: ByteNumber> VectorTask for DepthwiseByteTask<'_, X> {
    #[inline(always)]
    fn run(self) {
        let Self { picture, weights: (weights, weights_zero), chunks, sums } = self;
        let zero: i32 = picture.padding.into();
        let rows = 0..picture.rows.kernel;
        let mut gathered = GatheredInputs::new(picture.columns, 1, rows.len());
        for (chunk, sums) in chunks.iter().zip(sums) {
            gathered.select_chunks(std::slice::from_ref(chunk));
            gathered.gather(&picture, &rows);
            sums.fill(0);
            for (&weight, &tap) in weights.iter().zip(&gathered.tap_offsets) {
                let weight = i32::from(weight) - i32::from(weights_zero);
                for (sum, &input) in sums.iter_mut().zip(&gathered.window_rows[tap..]) {
                    let input: i32 = input.into();
                    *sum = sum.wrapping_add(weight * (input - zero));
                }
            }
        }
    }
}
