// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `mad`: the sum of absolute deviations from a rounded fixed-point mean.

/// Returns the rounded mean `floor((2^f * sum + floor(n / 2)) / n)`, in units of `2^-f` grey
/// levels.
#[must_use]
pub fn mean(sum: u64, n: u64, fraction_bits: u32) -> u64 {
    ((sum << fraction_bits) + n / 2) / n
}

/// Returns the deviation `|2^f * x - mean|` of a pixel.
#[must_use]
pub fn deviation(pixel: u16, mean: u64, fraction_bits: u32) -> u64 {
    (u64::from(pixel) << fraction_bits).abs_diff(mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_round_up() {
        assert_eq!([1, 2, 3, 5, 6].map(|sum| mean(sum, 4, 0)), [0, 1, 1, 1, 2]);
        assert_eq!(mean(2, 4, 1), 1);
        assert_eq!(mean(1, 4, 2), 1);
        // With n = 9 the half would be 4.5 ninths.
        assert_eq!([4, 5, 13, 14].map(|sum| mean(sum, 9, 0)), [0, 1, 1, 2]);
        assert_eq!((deviation(3, 5, 1), deviation(2, 5, 1)), (1, 1));
    }
}
