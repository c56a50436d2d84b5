// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is offered to an array or core while it takes nothing.

use super::random::Random;

/// What is offered while nothing is taken.
#[derive(Clone, Copy, Debug)]
pub(super) enum Manners {
    /// Nothing.
    Quiet,
    /// The next pixel, until it is taken.
    Patient,
    /// Garbage, which must not be taken, at every other clock.
    Rude,
}

impl Manners {
    /// Any, mostly the rude ones.
    pub(super) fn any(random: &mut Random) -> Self {
        match random.up_to(3) {
            0 => Self::Quiet,
            1 => Self::Patient,
            _ => Self::Rude,
        }
    }

    /// Whether something is offered at a clock at which nothing is taken, and what; without it garbage.
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
