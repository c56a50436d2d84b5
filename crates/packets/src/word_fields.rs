// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fields of the 64-bit words that all packets consist of.

use std::ops::RangeInclusive;

use crate::PacketError;

/// Returns the word at the beginning of these bytes; `None` if there are fewer than eight.
pub(crate) fn word(bytes: &[u8]) -> Option<u64> {
    bytes.first_chunk().map(|bytes| u64::from_le_bytes(*bytes))
}

/// Returns sixteen bits of a word, from bit `from` on.
pub(crate) fn bits16(word: u64, from: u32) -> u16 {
    let [a, b, ..] = (word >> from).to_le_bytes();
    u16::from_le_bytes([a, b])
}

/// Returns eight bits of a word, from bit `from` on.
pub(crate) fn bits8(word: u64, from: u32) -> u8 {
    (word >> from).to_le_bytes()[0]
}

/// Returns 32 bits of a word, from bit `from` on.
pub(crate) fn bits32(word: u64, from: u32) -> u32 {
    let [a, b, c, d, ..] = (word >> from).to_le_bytes();
    u32::from_le_bytes([a, b, c, d])
}

/// Converts a number to an index. This is lossless, because `usize` has at least 32 bits on every
/// machine that can hold a frame.
pub(crate) const fn index(value: u32) -> usize {
    value as usize
}

pub(crate) fn checked_field(
    field: &'static str,
    value: u64,
    range: RangeInclusive<u64>,
) -> Result<u64, PacketError> {
    let (&least, &most) = (range.start(), range.end());
    range.contains(&value).then_some(value).ok_or(PacketError::FieldOutOfRange {
        field,
        value,
        least,
        most,
    })
}

/// Returns the number if a field of 16 bits can hold it.
pub(crate) fn checked_u16(name: &'static str, value: u64) -> Result<u16, PacketError> {
    let value = checked_field(name, value, 0..=u16::MAX.into())?;
    Ok(u16::try_from(value).unwrap_or(u16::MAX))
}

/// Returns the number if a field of 8 bits can hold it.
pub(crate) fn checked_u8(name: &'static str, value: u32) -> Result<u8, PacketError> {
    let value = checked_field(name, value.into(), 0..=u8::MAX.into())?;
    Ok(u8::try_from(value).unwrap_or(u8::MAX))
}
