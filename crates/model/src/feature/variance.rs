// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `variance`: `n^2` times the variance, which is an integer.

/// Returns the square of a pixel.
#[must_use]
pub fn square(pixel: u16) -> u64 {
    u64::from(pixel) * u64::from(pixel)
}

/// Returns `n * sum(x^2) - sum(x)^2`, which is never negative.
#[must_use]
pub fn score(n: u64, sum: u64, square_sum: u64) -> u64 {
    n * square_sum - sum * sum
}
