// SPDX-License-Identifier: MIT OR Apache-2.0
//! How votes become SRS, and what SRS and TRS do to a region.

use foveate_design::{Combine, Design, Irrelevant};

/// SRS from the votes of the features.
pub(crate) fn combined(combine: Combine, mut votes: impl Iterator<Item = bool>) -> bool {
    match combine {
        Combine::Any => votes.any(|vote| vote),
        Combine::All => votes.all(|vote| vote),
    }
}

/// What happens to a region on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// Active: its current pixels are forwarded and shown.
    Forward,
    /// Its previous rendered pixels stay.
    Hold,
    /// It becomes black.
    Blank,
}

impl Action {
    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Hold => "hold",
            Self::Blank => "blank",
        }
    }

    /// The action for a region with these two bits.
    #[must_use]
    pub fn of(design: &Design, srs: bool, trs: bool) -> Self {
        match (trs, srs) {
            (true, true) => Self::Forward,
            (false, true) => Self::Hold,
            (_, false) => match design.irrelevant() {
                Irrelevant::Zero => Self::Blank,
                Irrelevant::Hold => Self::Hold,
            },
        }
    }
}
