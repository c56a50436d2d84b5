// SPDX-License-Identifier: MIT OR Apache-2.0
//! How votes become SRS, and what SRS and TRS do to a region.

use foveate_camera::{Action, Combine, Irrelevant};

/// SRS from the votes of the features.
pub(crate) fn combined(combine: Combine, mut votes: impl Iterator<Item = bool>) -> bool {
    match combine {
        Combine::Any => votes.any(|vote| vote),
        Combine::All => votes.all(|vote| vote),
    }
}

/// What becomes of a region with these two bits; `is_summary_due` is asked only where irrelevant regions send their means.
pub fn action(
    irrelevant: Irrelevant,
    srs: bool,
    trs: bool,
    is_summary_due: impl FnOnce() -> bool,
) -> Action {
    match (trs, srs) {
        (true, true) => Action::Forward,
        (false, true) => Action::Hold,
        (_, false) => match irrelevant {
            Irrelevant::Zero => Action::Blank,
            Irrelevant::Hold => Action::Hold,
            Irrelevant::Mean if is_summary_due() => Action::Summarize,
            Irrelevant::Mean => Action::Hold,
        },
    }
}
