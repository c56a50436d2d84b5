// SPDX-License-Identifier: MIT OR Apache-2.0
//! An event of a pixel, and the versions of the format.

use std::fmt;

/// An event of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelEvent {
    /// The column of the pixel.
    pub x: u16,
    /// The row of the pixel.
    pub y: u16,
    /// The time in microseconds.
    pub time_us: u64,
    /// True if the pixel became brighter: the polarity.
    pub is_brighter: bool,
}

/// A version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EvtVersion {
    /// EVT 2.0: a word of 32 bits for each event, which repeats its coordinates.
    Evt2,
    /// EVT 3.0: words of 16 bits, which state what changed. Events of one row share words.
    Evt3,
}

impl EvtVersion {
    /// The largest width and height in pixels.
    pub const MAX_SIDE: u32 = 1 << 11;

    /// Returns the version in the words of a header: `2.0` or `3.0`.
    pub(crate) fn number(self) -> &'static str {
        match self {
            Self::Evt2 => "2.0",
            Self::Evt3 => "3.0",
        }
    }

    /// Returns the number of bytes of a word.
    pub(crate) fn word_bytes(self) -> usize {
        match self {
            Self::Evt2 => 4,
            Self::Evt3 => 2,
        }
    }
}

impl fmt::Display for EvtVersion {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "EVT {}", self.number())
    }
}
