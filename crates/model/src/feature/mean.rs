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
