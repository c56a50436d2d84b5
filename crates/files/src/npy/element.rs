// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the values of an array are.

/// A type of elements that NumPy knows, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// Also truth values, 0 and 1.
    Unsigned8,
    /// Two bytes.
    Unsigned16,
    /// Four bytes.
    Unsigned32,
    /// Eight bytes.
    Unsigned64,
    /// Eight bytes, two's complement.
    Signed64,
    /// Four bytes, IEEE 754.
    Float32,
}

impl Element {
    /// The smallest unsigned type that holds `0..=max`.
    #[must_use]
    pub fn up_to(max: u64) -> Self {
        match max {
            0..=0xFF => Self::Unsigned8,
            0x100..=0xFFFF => Self::Unsigned16,
            0x1_0000..=0xFFFF_FFFF => Self::Unsigned32,
            _ => Self::Unsigned64,
        }
    }

    pub(crate) fn descr(self) -> &'static str {
        match self {
            Self::Unsigned8 => "|u1",
            Self::Unsigned16 => "<u2",
            Self::Unsigned32 => "<u4",
            Self::Unsigned64 => "<u8",
            Self::Signed64 => "<i8",
            Self::Float32 => "<f4",
        }
    }

    pub(crate) fn bytes(self) -> usize {
        match self {
            Self::Unsigned8 => 1,
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
        let descr = |max| Element::up_to(max).descr();
        assert_eq!([0, 255, 256, 65_535].map(descr), ["|u1", "|u1", "<u2", "<u2"]);
        assert_eq!([65_536, u64::from(u32::MAX), 1 << 32].map(descr), ["<u4", "<u4", "<u8"]);
    }
}
