// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution of each channel by itself, which has too few products per input to be worth gathering them.

use super::gather::{CHUNK, Chunk, Picture};
use foveate_lanes::{Level, Task};

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
        let offsets = picture.offsets();
        let mut gathered = vec![[0.0; CHUNK]; weights.len()];
        for &chunk in chunks {
            let mut sums = [bias; CHUNK];
            if let Some(start) = picture.inside(chunk) {
                for (&weight, &offset) in weights.iter().zip(&offsets) {
                    let mut inputs = [0.0; CHUNK];
                    picture.take(&picture.values[start + offset..], &mut inputs);
                    add::<FUSED>(weight, &inputs, &mut sums);
                }
            } else {
                // A product with padding is 0 here as in every other convolution.
                picture.gather_border(0, chunk, 0..CHUNK, &mut gathered);
                for (&weight, inputs) in weights.iter().zip(&gathered) {
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

/// Adds the products of one weight.
#[inline(always)]
fn add<const FUSED: bool>(weight: f32, inputs: &[f32; CHUNK], sums: &mut [f32; CHUNK]) {
    for (sum, &input) in sums.iter_mut().zip(inputs) {
        *sum = if FUSED { weight.mul_add(input, *sum) } else { weight * input + *sum };
    }
}
