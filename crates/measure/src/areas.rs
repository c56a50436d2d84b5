// SPDX-License-Identifier: MIT OR Apache-2.0
//! The areas, in pixels, where the decisions of two cameras differ. Areas are counted and not
//! regions, so that cameras with regions of different sizes can be compared.

use foveate_camera::RegionAction;
use serde::{Deserialize, Serialize};

use super::fixed_point::ratio;

/// The area of every combination of two states; the index is `ideal << STATE_BITS | candidate`.
pub(crate) type StateAreas = [u64; 1 << (2 * STATE_BITS)];

const STATE_BITS: usize = 4;
const SRS: u8 = 1;
const TRS: u8 = 2;
const ACTION: u8 = 12;
const SUMMARIZED: u8 = 12;

/// A table without any area.
pub(crate) const NO_AREAS: StateAreas = [0; 1 << (2 * STATE_BITS)];

/// All decisions about one region, in four bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DecisionState(u8);

impl DecisionState {
    /// Creates the state of a region from its relevance and its action.
    #[must_use]
    pub fn new(srs: bool, trs: bool, action: RegionAction) -> Self {
        let action = match action {
            RegionAction::Forward => 0,
            RegionAction::Hold => 4,
            RegionAction::Blank => 8,
            RegionAction::Summarize => SUMMARIZED,
        };
        Self((u8::from(srs) * SRS) | (u8::from(trs) * TRS) | action)
    }

    /// Returns the states of regions.
    pub fn of_regions<'o>(
        srs: &'o [bool],
        trs: &'o [bool],
        actions: &'o [RegionAction],
    ) -> impl Iterator<Item = Self> + 'o {
        let regions = srs.iter().zip(trs).zip(actions);
        regions.map(|((&srs, &trs), &action)| Self::new(srs, trs, action))
    }

    /// Returns true if SRS and TRS are both set.
    #[must_use]
    pub fn is_active(self) -> bool {
        self.0 & (SRS | TRS) == SRS | TRS
    }
}

pub(crate) fn state_pair_index(ideal: DecisionState, candidate: DecisionState) -> usize {
    usize::from(ideal.0) << STATE_BITS | usize::from(candidate.0)
}

/// The order of a frame in its clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FrameOrder {
    /// The first frame of a clip, in which every region has changed by definition.
    First,
    /// A frame after the first one, or an image of a data set.
    Later,
}

/// The areas that are active, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ActiveAreas {
    /// The area of all regions.
    pub all: u64,
    /// The area that is active in the ideal.
    pub ideal: u64,
    /// The area that is active in the candidate.
    pub candidate: u64,
    /// The area that is active in both.
    pub both: u64,
}

impl ActiveAreas {
    fn add(&mut self, other: &Self) {
        self.all += other.all;
        self.ideal += other.ideal;
        self.candidate += other.candidate;
        self.both += other.both;
    }
}

/// The areas in pixels, summed over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DecisionAreas {
    /// The area where SRS differs.
    pub srs: u64,
    /// The area where TRS differs.
    pub trs: u64,
    /// The area where the action differs.
    pub action: u64,
    /// The active areas of all frames.
    pub active: ActiveAreas,
    /// The active areas without the first frame of every clip.
    pub later: ActiveAreas,
    /// The area of regions whose summary the candidate sends.
    pub summarized: u64,
}

impl DecisionAreas {
    pub(crate) fn add_table(&mut self, table: &StateAreas, order: FrameOrder) {
        for (at, &area) in table.iter().enumerate().filter(|(_, area)| **area > 0) {
            let state = |shift: usize| {
                DecisionState(u8::try_from(at >> shift & 15).expect("a state has four bits"))
            };
            self.add_pair((state(STATE_BITS), state(0)), area, order);
        }
    }

    /// Adds an area in which the ideal and the candidate have these states.
    pub fn add_pair(
        &mut self,
        (ideal, candidate): (DecisionState, DecisionState),
        area: u64,
        order: FrameOrder,
    ) {
        let area_if = |yes: bool| if yes { area } else { 0 };
        let differs = |mask: u8| area_if((ideal.0 ^ candidate.0) & mask != 0);
        let active = ActiveAreas {
            all: area,
            ideal: area_if(ideal.is_active()),
            candidate: area_if(candidate.is_active()),
            both: area_if(ideal.is_active() && candidate.is_active()),
        };
        self.add(&Self {
            srs: differs(SRS),
            trs: differs(TRS),
            action: differs(ACTION),
            active,
            later: if order == FrameOrder::Later { active } else { ActiveAreas::default() },
            summarized: area_if(candidate.0 & ACTION == SUMMARIZED),
        });
    }

    /// Adds the areas of other frames.
    pub fn add(&mut self, other: &Self) {
        self.srs += other.srs;
        self.trs += other.trs;
        self.action += other.action;
        self.active.add(&other.active);
        self.later.add(&other.later);
        self.summarized += other.summarized;
    }

    /// Returns the share of the area where the action differs, 0..=1; 0 without frames.
    #[must_use]
    pub fn flips(&self) -> f64 {
        ratio(self.action, self.active.all, 0.0)
    }

    /// Returns the share of the ideal's active area that is not active in the candidate, 0..=1,
    /// without the first frame of every clip; 0 without such an area.
    #[must_use]
    pub fn missed(&self) -> f64 {
        ratio(self.later.ideal.saturating_sub(self.later.both), self.later.ideal, 0.0)
    }

    /// Returns the share of the candidate's active area that is not active in the ideal, 0..=1,
    /// without the first frame of every clip; 0 without such an area.
    #[must_use]
    pub fn false_alarms(&self) -> f64 {
        ratio(self.later.candidate.saturating_sub(self.later.both), self.later.candidate, 0.0)
    }
}
