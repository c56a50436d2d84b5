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
}
