// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fields of the 64-bit words that all packets consist of.

use std::ops::RangeInclusive;

use crate::PacketError;

/// The word that begins with these bytes; none where they are fewer than eight.
pub(crate) fn word(bytes: &[u8]) -> Option<u64> {
    bytes.first_chunk().map(|bytes| u64::from_le_bytes(*bytes))
}

/// Sixteen bits of a word, from bit `from` on.
pub(crate) fn short(word: u64, from: u32) -> u16 {
    let [a, b, ..] = (word >> from).to_le_bytes();
    u16::from_le_bytes([a, b])
}

/// Eight bits of a word, from bit `from` on.
pub(crate) fn byte(word: u64, from: u32) -> u8 {
    (word >> from).to_le_bytes()[0]
}

/// The half of a word that begins with bit `from`.
pub(crate) fn half(word: u64, from: u32) -> u32 {
    let [a, b, c, d, ..] = (word >> from).to_le_bytes();
    u32::from_le_bytes([a, b, c, d])
}

/// A number as an index. Lossless: `usize` has 32 bits or more wherever a frame can be held.
pub(crate) const fn index(value: u32) -> usize {
    value as usize
}

/// A number that its field takes.
pub(crate) fn field(
    field: &'static str,
    value: u64,
    range: RangeInclusive<u64>,
) -> Result<u64, PacketError> {
    let (&least, &most) = (range.start(), range.end());
    range.contains(&value).then_some(value).ok_or(PacketError::Field { field, value, least, most })
}

/// A number that a field of 16 bits takes.
pub(crate) fn narrow(name: &'static str, value: u64) -> Result<u16, PacketError> {
    let value = field(name, value, 0..=u16::MAX.into())?;
    Ok(u16::try_from(value).unwrap_or(u16::MAX))
}

/// A number that a field of 8 bits takes.
pub(crate) fn small(name: &'static str, value: u32) -> Result<u8, PacketError> {
    let value = field(name, value.into(), 0..=u8::MAX.into())?;
    Ok(u8::try_from(value).unwrap_or(u8::MAX))
}
