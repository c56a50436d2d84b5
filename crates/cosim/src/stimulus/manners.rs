// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pixels that are offered to an array or core while it takes nothing.

use super::random::Random;

/// The policy for the pixel port while nothing is taken.
#[derive(Clone, Copy, Debug)]
pub(super) enum Manners {
    /// Nothing is offered.
    Quiet,
    /// The next pixel is offered until it is taken.
    Patient,
    /// Random pixels, which must not be taken, are offered at about every second clock.
    Rude,
}

impl Manners {
    /// Returns a random policy; half of the time it is the one with random pixels.
    pub(super) fn any(random: &mut Random) -> Self {
        match random.up_to(3) {
            0 => Self::Quiet,
            1 => Self::Patient,
            _ => Self::Rude,
        }
    }

    /// Returns the valid bit for a clock at which nothing is taken, and the pixels; `None` stands
    /// for random pixels.
    pub(super) fn offer<'a>(
        self,
        next: Option<&'a [u16]>,
        random: &mut Random,
    ) -> (bool, Option<&'a [u16]>) {
        match self {
            Self::Quiet => (false, None),
            Self::Patient => (next.is_some(), next),
            Self::Rude => (random.one_in(2), None),
        }
    }
}
