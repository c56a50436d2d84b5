// SPDX-License-Identifier: MIT OR Apache-2.0
//! The areas, in pixels, where the decisions of two cameras differ. Areas are counted and not
//! regions, so that cameras with regions of different sizes can be compared.

use foveate_camera::RegionAction;
use serde::{Deserialize, Serialize};

/// The area of every combination of two states; the index is `ideal << STATE_BITS | candidate`.
pub(crate) type StateAreas = [u64; 1 << (2 * STATE_BITS)];

const STATE_BITS: usize = 4;
const SRS: u8 = 1;
const TRS: u8 = 2;
const ACTION: u8 = 12;
const SUMMARIZED: u8 = 12;

/// A table without any area.
pub(crate) const NO_AREAS: StateAreas = [0; 1 << (2 * STATE_BITS)];

/// Returns all decisions about one region in four bits.
pub(crate) fn decision_state(srs: bool, trs: bool, action: RegionAction) -> u8 {
    let action = match action {
        RegionAction::Forward => 0,
        RegionAction::Hold => 4,
        RegionAction::Blank => 8,
        RegionAction::Summarize => SUMMARIZED,
    };
    (u8::from(srs) * SRS) | (u8::from(trs) * TRS) | action
}

/// Returns the index of a pair of states in a [`StateAreas`].
pub(crate) fn state_pair_index(ideal: u8, candidate: u8) -> usize {
    usize::from(ideal) << STATE_BITS | usize::from(candidate)
}

/// The areas in pixels, summed over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct DecisionAreas {
    /// The area where SRS differs.
    pub(crate) srs: u64,
    /// The area where TRS differs.
    pub(crate) trs: u64,
    /// The area where the action differs.
    pub(crate) action: u64,
    /// The area that is active in the ideal.
    pub(crate) ideal: u64,
    /// The area that is active in the candidate.
    pub(crate) candidate: u64,
    /// The area that is active in both.
    pub(crate) both: u64,
    /// The area of regions whose summary the candidate sends.
    #[serde(default, skip_serializing_if = "is_zero_area")]
    pub(crate) summarized: u64,
}

/// Returns whether the area is 0. A stored tally then omits the key, as tallies of older versions
/// do, which had no summaries.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
fn is_zero_area(area: &u64) -> bool {
    *area == 0
}

impl DecisionAreas {
    /// Adds the areas of a table.
    pub(crate) fn add_table(&mut self, table: &StateAreas) {
        for (at, &area) in table.iter().enumerate().filter(|(_, area)| **area > 0) {
            let bits = |shift: usize| u8::try_from(at >> shift & 15).expect("four bits");
            let (ideal, candidate) = (bits(STATE_BITS), bits(0));
            let differs = |mask: u8| if (ideal ^ candidate) & mask == 0 { 0 } else { area };
            let active = |state: u8| state & (SRS | TRS) == SRS | TRS;
            let area_if = |yes: bool| if yes { area } else { 0 };
            self.add(&Self {
                srs: differs(SRS),
                trs: differs(TRS),
                action: differs(ACTION),
                ideal: area_if(active(ideal)),
                candidate: area_if(active(candidate)),
                both: area_if(active(ideal) && active(candidate)),
                summarized: area_if(candidate & ACTION == SUMMARIZED),
            });
        }
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.srs += other.srs;
        self.trs += other.trs;
        self.action += other.action;
        self.ideal += other.ideal;
        self.candidate += other.candidate;
        self.both += other.both;
        self.summarized += other.summarized;
    }
}
