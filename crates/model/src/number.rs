// SPDX-License-Identifier: MIT OR Apache-2.0
//! The few conversions between number types, each under a name that says why it is lossless.

/// A size, coordinate or number of a region as an index. Lossless: `usize` has 32 bits or more on
/// every platform that can hold a frame.
pub(crate) const fn index(value: u32) -> usize {
    value as usize
}

/// A number of items as it is calculated with. Lossless: no platform has a `usize` of more than 64 bits.
pub(crate) const fn amount(items: usize) -> u64 {
    items as u64
}

/// One for true: how a hit is counted.
pub(crate) fn hit(hit: bool) -> u64 {
    u64::from(hit)
}

/// How many items of an iterator are true, as a count of pixels.
pub(crate) fn count(hits: impl Iterator<Item = bool>) -> u32 {
    hits.map(u32::from).sum()
}
