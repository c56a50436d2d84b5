// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pixels that are offered to an array or core while it takes nothing.

use super::random::Random;

/// The policy for the pixel port while nothing is taken.
#[derive(Clone, Copy, Debug)]
pub(super) enum IdleInputPolicy {
    /// Nothing is offered.
    Nothing,
    /// The next pixel is offered until it is taken.
    NextPixel,
    /// Random pixels, which must not be taken, are offered at about every second clock.
    Garbage,
}

impl IdleInputPolicy {
    /// Returns a random policy; half of the time it is the one with random pixels.
    pub(super) fn random(random: &mut Random) -> Self {
        match random.up_to(3) {
            0 => Self::Nothing,
            1 => Self::NextPixel,
            _ => Self::Garbage,
        }
    }

    /// Returns the valid bit for a clock at which nothing is taken, and the pixels; `None` stands
    /// for random pixels.
    pub(super) fn offered_input<'a>(
        self,
        next: Option<&'a [u16]>,
        random: &mut Random,
    ) -> (bool, Option<&'a [u16]>) {
        match self {
            Self::Nothing => (false, None),
            Self::NextPixel => (next.is_some(), next),
            Self::Garbage => (random.one_in(2), None),
        }
    }
}
