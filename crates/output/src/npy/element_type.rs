// SPDX-License-Identifier: MIT OR Apache-2.0
//! The type of the values of an array.

/// A little-endian type of elements that NumPy supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementType {
    /// An unsigned integer of one byte, also used for truth values, 0 and 1.
    Unsigned8,
    /// A signed integer of one byte, in two's complement.
    Signed8,
    /// An unsigned integer of two bytes.
    Unsigned16,
    /// An unsigned integer of four bytes.
    Unsigned32,
    /// An unsigned integer of eight bytes.
    Unsigned64,
    /// A signed integer of eight bytes, in two's complement.
    Signed64,
    /// A floating-point number of four bytes (IEEE 754).
    Float32,
}

impl ElementType {
    /// Returns the smallest unsigned type that holds `0..=max`.
    #[must_use]
    pub fn smallest_for(max: u64) -> Self {
        match max {
            0..=0xFF => Self::Unsigned8,
            0x100..=0xFFFF => Self::Unsigned16,
            0x1_0000..=0xFFFF_FFFF => Self::Unsigned32,
            _ => Self::Unsigned64,
        }
    }

    pub(crate) fn numpy_name(self) -> &'static str {
        match self {
            Self::Unsigned8 => "|u1",
            Self::Signed8 => "|i1",
            Self::Unsigned16 => "<u2",
            Self::Unsigned32 => "<u4",
            Self::Unsigned64 => "<u8",
            Self::Signed64 => "<i8",
            Self::Float32 => "<f4",
        }
    }

    pub(crate) fn bytes(self) -> usize {
        match self {
            Self::Unsigned8 | Self::Signed8 => 1,
            Self::Unsigned16 => 2,
            Self::Unsigned32 | Self::Float32 => 4,
            Self::Unsigned64 | Self::Signed64 => 8,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_as_small_as_the_range_allows() {
        let descr = |max| ElementType::smallest_for(max).numpy_name();
        assert_eq!([0, 255, 256, 65_535].map(descr), ["|u1", "|u1", "<u2", "<u2"]);
        assert_eq!([65_536, u64::from(u32::MAX), 1 << 32].map(descr), ["<u4", "<u4", "<u8"]);
    }
}
