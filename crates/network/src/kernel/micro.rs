// SPDX-License-Identifier: MIT OR Apache-2.0
//! The innermost loop: a block of output channels at a panel of positions.

/// Adds the products of one weight per channel and one input per position, input by input.
///
/// `FUSED` rounds once per multiplication and addition; every processor with AVX2 has an instruction for it. How many channels there are
/// matters for speed alone: loops over 4, 6 or 12 of them become vector instructions, those over 8 or 16 do not.
#[inline(always)]
pub(super) fn multiply<const CHANNELS: usize, const LANES: usize, const FUSED: bool>(
    weights: &[[f32; CHANNELS]],
    inputs: &[[f32; LANES]],
    sums: &mut [[f32; LANES]; CHANNELS],
) {
    let mut own = *sums;
    for (weights, inputs) in weights.iter().zip(inputs) {
        for channel in 0..CHANNELS {
            for lane in 0..LANES {
                let sum = &mut own[channel][lane];
                *sum = if FUSED {
                    weights[channel].mul_add(inputs[lane], *sum)
                } else {
                    weights[channel] * inputs[lane] + *sum
                };
            }
        }
    }
    *sums = own;
}
