// SPDX-License-Identifier: MIT OR Apache-2.0
//! The innermost loop: a block of output channels at a panel of positions.

use super::chunks::CHUNK_POSITIONS;
use super::gathered_inputs::GatheredInputs;

/// Adds the products of one weight per channel and one input per position, input by input.
///
/// The inputs of each [`CHUNK_POSITIONS`] begin at its offset in `places`. `IS_ROW` says that the
/// chunks follow each other, and so do their offsets.
///
/// `FUSED` says that a multiplication and an addition are rounded once; every processor with AVX2
/// has an instruction for this. The number of channels matters only for speed: loops over 4, 6 or
/// 12 channels become vector instructions, loops over 8 or 16 do not.
#[inline(always)]
pub(super) fn multiply<
    const CHANNELS: usize,
    const VALUES: usize,
    const IS_ROW: bool,
    const FUSED: bool,
>(
    weights: &[[f32; CHANNELS]],
    gathered: &GatheredInputs,
    places: &[usize],
    sums: &mut [[f32; VALUES]; CHANNELS],
) {
    // A local copy of the sums can stay in registers during the loop.
    let mut register_sums = *sums;
    let GatheredInputs { tap_offsets: taps, window_rows: rows, .. } = gathered;
    for (weights, &tap) in weights.iter().zip(taps) {
        let mut inputs = [0.0; VALUES];
        if IS_ROW {
            inputs.copy_from_slice(&rows[places[0] + tap..][..VALUES]);
        } else {
            for (inputs, place) in inputs.chunks_mut(CHUNK_POSITIONS).zip(places) {
                inputs.copy_from_slice(&rows[place + tap..][..CHUNK_POSITIONS]);
            }
        }
        for channel in 0..CHANNELS {
            for value in 0..VALUES {
                let sum = &mut register_sums[channel][value];
                *sum = if FUSED {
                    weights[channel].mul_add(inputs[value], *sum)
                } else {
                    weights[channel] * inputs[value] + *sum
                };
            }
        }
    }
    *sums = register_sums;
}
