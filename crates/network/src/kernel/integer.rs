// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution of 8-bit values with exact sums, in the loops of the floating-point convolution.
//!
//! The product of two differences of 8-bit values is at most 255 x 255, so a sum of [`EXACT`] of
//! them is below 2^24. A 32-bit floating-point value holds every integer up to 2^24. The
//! floating-point loops, which are the fastest, therefore make exact sums of so many products in
//! any order. These sums are then added as 32-bit integers.

use super::blocking::Blocking;
use super::chunks::{CHUNK, Chunk};
use super::gather::{Gathered, Picture};
use super::panels::{Outputs, add_block};
use super::weights::Weights;
use crate::values::{Byte, Number};
use foveate_lanes::{Level, PanelTask, Task};
use std::ops::Range;

/// The number of products whose sum is exact. A row of the window must not have more.
pub(crate) const EXACT: usize = 256;
/// The number of panels that share a pass over the weights.
const GROUP: usize = 3;
/// The number of channels of the largest block.
const LARGEST: usize = 12;

/// The packed weights of a group of channels. Unsigned weights and their zero points are stored
/// less 128.
#[derive(Clone, Debug)]
pub(crate) struct ByteWeights {
    packed: Weights<i8>,
    /// One zero point per channel.
    zeros: Vec<f32>,
}

impl ByteWeights {
    /// Packs a row of `depth` weights per channel.
    pub(crate) fn new(rows: &[i8], depth: usize, zeros: &[i8], blocking: Blocking) -> Self {
        let packed = Weights::new(rows, depth, &[], blocking);
        let zeros = zeros.iter().copied().map(f32::from).collect();
        Self { packed, zeros }
    }

    pub(crate) fn packed(&self) -> &Weights<i8> {
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
        let packed = self.packed.of(block, inputs);
        let mut zeros = [0.0; LARGEST];
        for (to, channel) in zeros.iter_mut().zip(block.clone()) {
            *to = self.zeros.get(channel).copied().unwrap_or_default();
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
pub(crate) fn convolve_bytes<X: Byte, Y: Number>(
    level: Level,
    picture: &Picture<'_, X>,
    weights: &ByteWeights,
    chunks: &[Chunk],
    outputs: Outputs<'_, Y>,
    finish: impl Fn(usize, i32) -> Y,
) {
    let Outputs { mut planes, first: start, blocks, width } = outputs;
    let (Some(first), Some(last)) = (blocks.first(), blocks.last()) else { return };
    let (first, stride) = (first.start, last.end - first.start);
    let taps = picture.columns.kernel;
    let rows = weights.packed.depth() / taps;
    let at_once = rows.min(EXACT / taps);
    let lanes = weights.packed.blocking().lanes;
    let room = (picture.columns, GROUP * lanes / CHUNK, at_once);
    let mut gathered = Gathered::new(room.0, room.1, room.2);
    let mut wide = Gathered::new(room.0, room.1, room.2);
    let mut products = vec![0.0; at_once * taps * LARGEST];
    let mut sums = vec![0i32; stride * GROUP * lanes];
    for chunks in chunks.chunks(GROUP * lanes / CHUNK) {
        let panels = chunks.len().div_ceil(lanes / CHUNK);
        sums.fill(0);
        gathered.choose(chunks);
        wide.choose(chunks);
        for from in (0..rows).step_by(at_once) {
            let rows = from..rows.min(from + at_once);
            let inputs = rows.start * taps..rows.end * taps;
            let (gathered, wide) = (&mut gathered, &mut wide);
            level.run(Gather { picture, rows, gathered, wide });
            let (products, sums) = (&mut products, &mut sums);
            level.run_panels(Multiply {
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
        for (sums, chunks) in sums.chunks(stride * lanes).zip(chunks.chunks(lanes / CHUNK)) {
            for ((channel, sums), plane) in (first..).zip(sums.chunks(lanes)).zip(&mut planes) {
                for (sums, chunk) in sums.chunks(CHUNK).zip(chunks) {
                    let places = chunk.places(width);
                    let to = &mut plane[places.start - start..places.end - start];
                    for (output, &sum) in to.iter_mut().zip(sums) {
                        *output = finish(channel, sum);
                    }
                }
            }
        }
    }
}

/// Gathers rows of the window, and subtracts the zero point of the inputs.
struct Gather<'a, X> {
    picture: &'a Picture<'a, X>,
    rows: Range<usize>,
    gathered: &'a mut Gathered<X>,
    wide: &'a mut Gathered,
}

impl<X: Byte> Task for Gather<'_, X> {
    #[inline(always)]
    fn run(self) {
        let Self { picture, rows, gathered, wide } = self;
        let zero: f32 = picture.padding.into();
        gathered.gather(picture, &rows);
        let values = gathered.pitch * rows.len();
        for (wide, &input) in wide.rows[..values].iter_mut().zip(&gathered.rows) {
            let input: f32 = input.into();
            *wide = input - zero;
        }
    }
}

/// Adds the products of some inputs to the sums of all panels, each of which has `stride` channels.
/// This takes most of the time. The task is compiled once, because it depends neither on the type
/// of the inputs nor on that of the outputs.
struct Multiply<'a> {
    weights: &'a ByteWeights,
    blocks: &'a [Range<usize>],
    inputs: Range<usize>,
    wide: &'a Gathered,
    panels: usize,
    /// Room for the widened weights of a block.
    products: &'a mut [f32],
    /// The sums: in each panel a row of lanes per channel.
    sums: &'a mut [i32],
    stride: usize,
}

impl PanelTask for Multiply<'_> {
    #[inline(always)]
    fn run<const LANES: usize, const FUSED: bool>(self) {
        let Self { weights, blocks, inputs, wide, panels, products, sums, stride } = self;
        let sums = sums.as_chunks_mut::<LANES>().0;
        let first = blocks.first().map_or(0, |block| block.start);
        for block in blocks {
            let products = weights.widen(block, &inputs, products);
            for panel in 0..panels {
                let mut exact = [[0.0; LANES]; LARGEST];
                let exact = &mut exact[..block.len()];
                add_block::<LANES, FUSED>(products, wide, panel, exact);
                let sums = &mut sums[panel * stride + block.start - first..];
                for (sums, exact) in sums.iter_mut().zip(exact) {
                    for lane in 0..LANES {
                        #[allow(clippy::cast_possible_truncation, reason = "an integer")]
                        let exact = exact[lane] as i32;
                        sums[lane] = sums[lane].wrapping_add(exact);
                    }
                }
            }
        }
    }
}

/// The depthwise convolution of one channel at the chunks.
pub(crate) struct DepthwiseBytes<'a, X> {
    /// The input, whose padding is its zero point.
    pub(crate) picture: Picture<'a, X>,
    /// The weights of the kernel in row-major order, with their zero point.
    pub(crate) weights: (&'a [i8], i8),
    pub(crate) chunks: &'a [Chunk],
    /// The sums, one array for each chunk.
    pub(crate) sums: &'a mut [[i32; CHUNK]],
}

impl<X: Byte> Task for DepthwiseBytes<'_, X> {
    #[inline(always)]
    fn run(self) {
        let Self { picture, weights: (weights, weights_zero), chunks, sums } = self;
        let zero: i32 = picture.padding.into();
        let rows = 0..picture.rows.kernel;
        let mut gathered = Gathered::new(picture.columns, 1, rows.len());
        for (chunk, sums) in chunks.iter().zip(sums) {
            gathered.choose(std::slice::from_ref(chunk));
            gathered.gather(&picture, &rows);
            sums.fill(0);
            for (&weight, &tap) in weights.iter().zip(&gathered.taps) {
                let weight = i32::from(weight) - i32::from(weights_zero);
                for (sum, &input) in sums.iter_mut().zip(&gathered.rows[tap..]) {
                    let input: i32 = input.into();
                    *sum = sum.wrapping_add(weight * (input - zero));
                }
            }
        }
    }
}
