// SPDX-License-Identifier: MIT OR Apache-2.0
//! Conversions between types of numbers. The comment on each says why it is lossless.

/// Converts a size, a coordinate or the number of a region to an index. This is lossless because
/// `usize` has 32 bits or more on every platform that can hold a frame.
pub(crate) const fn index(value: u32) -> usize {
    value as usize
}

/// Converts a number of items for arithmetic. This is lossless because no platform has a `usize` of
/// more than 64 bits.
pub(crate) const fn as_u64(items: usize) -> u64 {
    items as u64
}

/// Returns 1 for true and 0 for false, to count hits.
pub(crate) fn bool_as_count(hit: bool) -> u64 {
    u64::from(hit)
}

pub(crate) fn count_true(hits: impl Iterator<Item = bool>) -> u32 {
    hits.map(u32::from).sum()
}
