// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution at any set of positions: their inputs are gathered into panels, which are multiplied with the weights.

use super::blocking::Blocking;
use super::chunks::{CHUNK, Chunk};
use super::gather::{Gathered, Picture};
use super::micro::multiply;
use super::weights::Weights;
use foveate_lanes::{Level, Task};
use std::ops::Range;

/// Inputs that are multiplied before the next are gathered: those of a panel stay in the nearest cache.
const DEPTH: usize = 288;
/// Panels that share a pass over the weights.
const GROUP: usize = 6;

/// Positions that are computed for so many chunks: whole panels.
pub(crate) fn scheduled(chunks: usize, blocking: Blocking) -> usize {
    (chunks * CHUNK).next_multiple_of(blocking.lanes)
}

/// Some rows of some channels of the outputs.
pub(crate) struct Outputs<'a, T = f32> {
    /// These rows of each channel, of `width` positions.
    pub(crate) planes: Vec<&'a mut [T]>,
    /// The first row.
    pub(crate) top: usize,
    /// The blocks of these channels.
    pub(crate) blocks: &'a [Range<usize>],
    pub(crate) width: usize,
}

/// Computes the channels of `outputs` at the chunks, which are in their rows. `finish` is applied to every output.
pub(crate) fn convolve(
    level: Level,
    picture: &Picture<'_>,
    weights: &Weights,
    chunks: &[Chunk],
    outputs: Outputs<'_>,
    finish: impl Fn(f32) -> f32,
) {
    let work = Work { picture, weights, chunks, outputs, finish };
    match weights.blocking().lanes {
        32 => level.run(Of::<_, 32, true>(work)),
        16 => level.run(Of::<_, 16, true>(work)),
        _ => level.run(Of::<_, 8, false>(work)),
    }
}

struct Work<'a, F> {
    picture: &'a Picture<'a>,
    weights: &'a Weights,
    chunks: &'a [Chunk],
    outputs: Outputs<'a>,
    finish: F,
}

/// The work for panels of so many positions.
struct Of<'a, F, const LANES: usize, const FUSED: bool>(Work<'a, F>);

impl<F: Fn(f32) -> f32, const LANES: usize, const FUSED: bool> Task for Of<'_, F, LANES, FUSED> {
    #[inline(always)]
    fn run(self) {
        let Work { picture, weights, chunks, outputs, finish } = self.0;
        let Outputs { mut planes, top, blocks, width } = outputs;
        let (Some(first), Some(last)) = (blocks.first(), blocks.last()) else { return };
        let (first, stride) = (first.start, last.end - first.start);
        let taps = picture.columns.kernel;
        let rows = weights.depth() / taps;
        let at_once = rows.min((DEPTH / taps).max(1));
        let mut gathered = Gathered::new(picture.columns, GROUP * LANES / CHUNK, at_once);
        let mut sums = vec![[0.0; LANES]; stride * GROUP];
        for group in chunks.chunks(GROUP * LANES / CHUNK) {
            let panels = group.len().div_ceil(LANES / CHUNK);
            for panel in sums.chunks_mut(stride).take(panels) {
                for (channel, sum) in (first..).zip(panel) {
                    *sum = [weights.bias(channel); LANES];
                }
            }
            gathered.choose(group);
            for from in (0..rows).step_by(at_once) {
                let rows = from..rows.min(from + at_once);
                gathered.gather(picture, &rows);
                for block in blocks {
                    let products = weights.of(block, &(rows.start * taps..rows.end * taps));
                    for (panel, sums) in sums.chunks_mut(stride).take(panels).enumerate() {
                        let sums = &mut sums[block.start - first..][..block.len()];
                        add_block::<LANES, FUSED>(products, &gathered, panel, sums);
                    }
                }
            }
            for (sums, chunks) in sums.chunks(stride).zip(group.chunks(LANES / CHUNK)) {
                for (sums, plane) in sums.iter().zip(&mut planes) {
                    scatter(sums, chunks, (plane, top, width), &finish);
                }
            }
        }
    }
}

/// Adds the products of a block.
#[inline(always)]
pub(super) fn add_block<const LANES: usize, const FUSED: bool>(
    weights: &[f32],
    inputs: &Gathered,
    panel: usize,
    sums: &mut [[f32; LANES]],
) {
    match (LANES, sums.len()) {
        (32, 12) => add::<LANES, 12, FUSED>(weights, inputs, panel, sums),
        (32, 10) => add::<LANES, 10, FUSED>(weights, inputs, panel, sums),
        (16 | 32, 6) => add::<LANES, 6, FUSED>(weights, inputs, panel, sums),
        _ => add::<LANES, 4, FUSED>(weights, inputs, panel, sums),
    }
}

/// Adds the products of a block of so many channels.
#[inline(always)]
fn add<const LANES: usize, const CHANNELS: usize, const FUSED: bool>(
    weights: &[f32],
    inputs: &Gathered,
    panel: usize,
    sums: &mut [[f32; LANES]],
) {
    let sums = sums.try_into().expect("a block has a sum for each of its channels");
    let weights = weights.as_chunks().0;
    let places = &inputs.places[panel * LANES / CHUNK..][..LANES / CHUNK];
    if places.windows(2).all(|pair| pair[0] + CHUNK == pair[1]) {
        multiply::<CHANNELS, LANES, true, FUSED>(weights, inputs, places, sums);
    } else {
        multiply::<CHANNELS, LANES, false, FUSED>(weights, inputs, places, sums);
    }
}

/// Writes the outputs of a channel to their positions.
#[inline(always)]
fn scatter<const LANES: usize>(
    sums: &[f32; LANES],
    chunks: &[Chunk],
    (plane, top, width): (&mut [f32], usize, usize),
    finish: impl Fn(f32) -> f32,
) {
    let place = |chunk: &Chunk| (chunk.y - top) * width + chunk.x;
    let is_row = chunks.windows(2).all(|pair| place(&pair[0]) + CHUNK == place(&pair[1]));
    if is_row && chunks.len() * CHUNK == LANES && width >= CHUNK {
        let to: &mut [f32; LANES] =
            plane[place(&chunks[0])..].first_chunk_mut().expect("chunks are inside");
        to.iter_mut().zip(sums).for_each(|(output, &sum)| *output = finish(sum));
        return;
    }
    for (sums, chunk) in sums.chunks(CHUNK).zip(chunks) {
        let y = chunk.y - top;
        let row = &mut plane[y * width + chunk.x..(y + 1) * width];
        for (output, &sum) in row.iter_mut().zip(sums) {
            *output = finish(sum);
        }
    }
}
