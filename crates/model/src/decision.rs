// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rules by which votes become SRS, and by which SRS and TRS become an action.

use foveate_camera::{Action, Combine, Irrelevant};

/// Returns SRS for the votes of the features.
pub(crate) fn combined(combine: Combine, mut votes: impl Iterator<Item = bool>) -> bool {
    match combine {
        Combine::Any => votes.any(|vote| vote),
        Combine::All => votes.all(|vote| vote),
    }
}

/// Returns the action on a region for its SRS and TRS. `is_summary_due` is called only if
/// irrelevant regions send their means.
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
