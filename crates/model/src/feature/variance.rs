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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_region_stays_inside() {
        // The region has 64x64 pixels of 16 bits, half of them at the maximum.
        let max = u64::from(u16::MAX);
        assert_eq!(score(4096, 2048 * max, 2048 * square(u16::MAX)), max * max * 2048 * 2048);
        assert_eq!(score(4096, 4096 * max, 4096 * square(u16::MAX)), 0);
        assert_eq!(score(4, 1 + 2 + 3 + 4, 1 + 4 + 9 + 16), 20);
    }
}
