// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pauses between pixels and between frames.

use super::random::Random;

/// The pattern of pauses between pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GapPattern {
    /// A pixel comes at every clock, and frames follow at once.
    None,
    /// Pauses are random, and most frames follow at once.
    Random,
    /// Pixels come in bursts, with pauses of many clocks; frames are often far enough apart for a
    /// flush.
    Bursts,
    /// One clock passes before the last of so many pixels.
    Periodic(usize),
}

impl GapPattern {
    /// The patterns that sequences take in turn.
    pub(super) const IN_TURN: [Self; 3] = [Self::None, Self::Random, Self::Bursts];

    /// Returns the number of clocks without a pixel before the one at this place of a frame.
    pub(super) fn before_pixel(self, place: usize, random: &mut Random) -> u64 {
        match self {
            Self::None => 0,
            Self::Random if random.one_in(3) => 1 + random.up_to(2),
            Self::Bursts if random.one_in(40) => 1 + random.up_to(30),
            Self::Random | Self::Bursts => 0,
            Self::Periodic(period) => u64::from(place % period == period - 1),
        }
    }

    /// Returns the number of clocks without a pixel between two frames; after `settle` clocks
    /// everything has settled.
    pub(super) fn between_frames(self, settle: u64, random: &mut Random) -> u64 {
        match self {
            Self::None | Self::Periodic(_) => 0,
            Self::Random => match random.up_to(3) {
                0 => 1,
                1 => random.up_to(settle),
                _ => 0,
            },
            Self::Bursts => match random.up_to(2) {
                0 => 0,
                1 => random.up_to(settle),
                _ => settle,
            },
        }
    }
}
