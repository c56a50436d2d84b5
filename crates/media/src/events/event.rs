// SPDX-License-Identifier: MIT OR Apache-2.0
//! An event of a pixel ([`PixelEvent`]), and the formats of files of such events
//! ([`EventFormat`]).

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

/// A format of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventFormat {
    /// EVT 2.0: a word of 32 bits for each event, which repeats its coordinates.
    Evt2,
    /// EVT 3.0: words of 16 bits, which state what changed. Events of one row share words.
    Evt3,
    /// AEDAT4: packets of events with 16 bytes each, mostly compressed.
    Aedat4,
}

impl EventFormat {
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Evt2, Self::Evt3, Self::Aedat4];

    /// Returns the largest width and height of frames in pixels.
    #[must_use]
    pub fn max_side(self) -> u32 {
        match self {
            Self::Evt2 | Self::Evt3 => 1 << 11,
            // A coordinate has 16 bits with a sign, and so has the number of columns in some
            // readers.
            Self::Aedat4 => (1 << 15) - 1,
        }
    }
}

impl fmt::Display for EventFormat {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Evt2 => "EVT 2.0",
            Self::Evt3 => "EVT 3.0",
            Self::Aedat4 => "AEDAT4",
        })
    }
}
