// SPDX-License-Identifier: MIT OR Apache-2.0
//! The constants that all parts of the street share: the position of the ground, and the time of
//! day.

/// Position of the feet of the houses in units from the top.
pub(super) const GROUND: i64 = 128;

/// The time of day of the street, with its weather.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TimeOfDay {
    Day,
    Night,
}

impl TimeOfDay {
    /// Returns the brightness of daylight in 256ths.
    pub(super) fn light(self) -> u32 {
        match self {
            Self::Day => 256,
            Self::Night => 52,
        }
    }
}
