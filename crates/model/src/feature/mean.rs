// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rounded fixed-point mean of a region, which `mad` and `segment` share.

use crate::region::RegionView;

/// Returns the rounded mean `floor((2^f * sum + floor(n / 2)) / n)`, in units of `2^-f` grey
/// levels.
#[must_use]
pub fn rounded_mean(sum: u64, n: u64, fraction_bits: u32) -> u64 {
    ((sum << fraction_bits) + n / 2) / n
}

/// Returns the rounded mean of a region.
pub(crate) fn region_mean(region: &impl RegionView, fraction_bits: u32) -> u64 {
    let sum = region.pixels().map(u64::from).sum();
    rounded_mean(sum, region.pixel_count(), fraction_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_round_up() {
        assert_eq!([1, 2, 3, 5, 6].map(|sum| rounded_mean(sum, 4, 0)), [0, 1, 1, 1, 2]);
        assert_eq!(rounded_mean(2, 4, 1), 1);
        assert_eq!(rounded_mean(1, 4, 2), 1);
        // With n = 9 the half would be 4.5 ninths.
        assert_eq!([4, 5, 13, 14].map(|sum| rounded_mean(sum, 9, 0)), [0, 1, 1, 2]);
    }
}
