// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rules by which votes become SRS, and by which SRS and TRS become an action.

use foveate_camera::{IrrelevantRendering, RegionAction, VoteCombination};

/// Returns SRS for the votes of the features.
pub(crate) fn combine_votes(
    combine: VoteCombination,
    mut votes: impl Iterator<Item = bool>,
) -> bool {
    match combine {
        VoteCombination::Any => votes.any(|vote| vote),
        VoteCombination::All => votes.all(|vote| vote),
    }
}

/// Returns the action on a region for its SRS and TRS. `is_summary_due` is called only if
/// irrelevant regions send their means.
pub fn region_action(
    irrelevant: IrrelevantRendering,
    srs: bool,
    trs: bool,
    is_summary_due: impl FnOnce() -> bool,
) -> RegionAction {
    match (trs, srs) {
        (true, true) => RegionAction::Forward,
        (false, true) => RegionAction::Hold,
        (_, false) => match irrelevant {
            IrrelevantRendering::Zero => RegionAction::Blank,
            IrrelevantRendering::Hold => RegionAction::Hold,
            IrrelevantRendering::Mean if is_summary_due() => RegionAction::Summarize,
            IrrelevantRendering::Mean => RegionAction::Hold,
        },
    }
}
