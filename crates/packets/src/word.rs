// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fields of the 64-bit words that all packets consist of.

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

/// A field of 16 bits. Sizes, rows and columns of a design are at most 16,384.
pub(crate) fn field(value: u32) -> u64 {
    u64::from(value & 0xFFFF)
}
