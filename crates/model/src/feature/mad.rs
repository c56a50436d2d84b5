// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `mad`: the sum of absolute deviations from the rounded mean.

/// Returns the deviation `|2^f * x - mean|` of a pixel.
#[must_use]
pub fn deviation(pixel: u16, mean: u64, fraction_bits: u32) -> u64 {
    (u64::from(pixel) << fraction_bits).abs_diff(mean)
}
