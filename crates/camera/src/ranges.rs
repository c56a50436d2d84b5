// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ranges of keys that depend on no other key. Checks, messages and lists of keys take them from here.

use std::ops::RangeInclusive;

use crate::ConfigError;

/// Largest frame side in pixels; keeps every count of regions and pixels far inside 32 bits.
pub const MAX_SIDE: u32 = 16_384;
/// Bits per pixel P.
pub const PIXEL_BITS: RangeInclusive<u32> = 1..=16;
/// Sides of a region N in pixels.
pub const REGION_SIZES: RangeInclusive<u32> = 2..=64;
/// Blocks per side q of a region's summary.
pub const SUMMARY_BLOCKS: &[u32] = &[1, 2, 4];
/// Fraction bits of the mean of `mad`, for the largest region.
pub const MEAN_FRACTION_BITS: RangeInclusive<u32> = 0..=12;

/// The largest level where differences reach `max`: one that is exceeded by some, unless what has none `always` passes.
pub(crate) fn largest_level(max: u32, always: bool) -> u32 {
    if always { max } else { max - 1 }
}

/// Refuses the `value` of a `key` that is not in its range; `why` follows the range in the message.
///
/// # Errors
/// [`ConfigError::Range`].
pub fn in_range(
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
    fn a_mean_of_the_largest_region_can_be_exact() {
        let largest = u64::from(*REGION_SIZES.end());
        assert_eq!(*MEAN_FRACTION_BITS.end(), crate::index_bits(largest * largest));
    }
}
