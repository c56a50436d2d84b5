// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ranges of keys that do not depend on other keys. Checks, messages and lists of keys use
//! these constants.

use std::ops::RangeInclusive;

use crate::ConfigError;

/// Largest side of a frame in pixels. It keeps every count of regions and pixels far below 2^32.
pub const MAX_SIDE: u32 = 16_384;
/// Valid bits per pixel P.
pub const PIXEL_BITS: RangeInclusive<u32> = 1..=16;
/// Valid sides of a region N in pixels.
pub const REGION_SIZES: RangeInclusive<u32> = 2..=64;
/// Valid numbers of blocks per side q of the summary of a region.
pub const SUMMARY_BLOCKS: &[u32] = &[1, 2, 4];
/// Valid fraction bits of the mean of `mad` and `segment`, for the largest region.
pub const MEAN_FRACTION_BITS: RangeInclusive<u32> = 0..=12;

/// Valid radii of the search of `flow`, for regions of 4x4 pixels or more.
pub const FLOW_RADII: RangeInclusive<u32> = 1..=3;

/// Returns the largest level that a difference of at most `max` can exceed, or `max` if the score
/// passes its minimum without hits too (`always`).
pub(crate) fn largest_level(max: u32, always: bool) -> u32 {
    if always { max } else { max - 1 }
}

/// Returns the largest radius of the search of `flow` in regions with `side` pixels a side. Some
/// pixel must have a partner at every displacement.
pub(crate) fn largest_flow_radius(side: u32) -> u32 {
    (*FLOW_RADII.end()).min(side - 1)
}

/// Refuses the `value` of a `key` that is not in `range`. The message has `why` after the range.
///
/// # Errors
/// Returns [`ConfigError::Range`] if the value is outside the range.
pub fn check_range(
    key: &str,
    value: u32,
    range: RangeInclusive<u32>,
    why: &str,
) -> Result<(), ConfigError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(ConfigError::Range {
        key: key.to_owned(),
        value: value.to_string(),
        valid: format!("{}..={}{why}", range.start(), range.end()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_regions_have_small_displacements() {
        assert_eq!([2, 3, 4, 64].map(largest_flow_radius), [1, 2, 3, 3]);
    }

    #[test]
    fn a_mean_of_the_largest_region_can_be_exact() {
        let largest = u64::from(*REGION_SIZES.end());
        assert_eq!(*MEAN_FRACTION_BITS.end(), crate::index_bits(largest * largest));
    }
}
