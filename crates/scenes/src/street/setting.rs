// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the street lies, and at what time of day: what all that is painted has in common.

/// Where the houses stand, in units from the top.
pub(super) const GROUND: i64 = 128;

/// Time of day and weather.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mood {
    Day,
    Night,
}

impl Mood {
    /// Daylight in 256ths.
    pub(super) fn light(self) -> u32 {
        match self {
            Self::Day => 256,
            Self::Night => 52,
        }
    }
}
