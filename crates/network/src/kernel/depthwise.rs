// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution of each channel by itself.

use super::chunks::{CHUNK, Chunk};
use super::gather::{Gathered, Picture};
use foveate_lanes::{Level, Task};

/// Chunks whose inputs are gathered at once.
const GROUP: usize = 8;

/// One channel.
pub(crate) struct Depthwise<'a, F> {
    pub(crate) picture: Picture<'a>,
    /// Row by row.
    pub(crate) weights: &'a [f32],
    pub(crate) bias: f32,
    pub(crate) chunks: &'a [Chunk],
    /// The channel's outputs, in rows of `width`.
    pub(crate) outputs: &'a mut [f32],
    pub(crate) width: usize,
    pub(crate) finish: F,
}

impl<F: Fn(f32) -> f32> Depthwise<'_, F> {
    pub(crate) fn convolve(self, level: Level) {
        if level.register_bits() > 128 {
            level.run(Of::<_, true>(self));
        } else {
            level.run(Of::<_, false>(self));
        }
    }
}

struct Of<'a, F, const FUSED: bool>(Depthwise<'a, F>);

impl<F: Fn(f32) -> f32, const FUSED: bool> Task for Of<'_, F, FUSED> {
    #[inline(always)]
    fn run(self) {
        let Depthwise { picture, weights, bias, chunks, outputs, width, finish } = self.0;
        let rows = 0..picture.rows.kernel;
        let mut gathered = Gathered::new(picture.columns, GROUP, rows.len());
        for group in chunks.chunks(GROUP) {
            gathered.choose(group);
            gathered.gather(&picture, &rows);
            let Gathered { rows, pitch, taps, .. } = &gathered;
            for (chunk, place) in group.iter().zip(&gathered.places) {
                let mut sums = [bias; CHUNK];
                for (weights, row) in weights.chunks(taps.len()).zip(rows.chunks(*pitch)) {
                    for (&weight, tap) in weights.iter().zip(taps) {
                        let inputs = row[place + tap..].first_chunk();
                        let inputs = inputs.expect("a tap has an input for each position");
                        add::<FUSED>(weight, inputs, &mut sums);
                    }
                }
                let row = &mut outputs[chunk.y * width + chunk.x..(chunk.y + 1) * width];
                for (output, sum) in row.iter_mut().zip(sums) {
                    *output = finish(sum);
                }
            }
        }
    }
}

/// Adds the products of one weight.
#[inline(always)]
fn add<const FUSED: bool>(weight: f32, inputs: &[f32; CHUNK], sums: &mut [f32; CHUNK]) {
    for (sum, &input) in sums.iter_mut().zip(inputs) {
        *sum = if FUSED { weight.mul_add(input, *sum) } else { weight * input + *sum };
    }
}
