// SPDX-License-Identifier: MIT OR Apache-2.0
//! When a region that has been judged is decided on the ports: a fixed number of clocks after its last word
//! has come to the tail, or after its second pass.

use foveate_design::{Action, RasterTiming};

use super::due::{Due, take_due};
use crate::verdict::Verdict;

/// A region of one frame, all of whose words have come to the tail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Complete {
    /// Its number.
    pub(super) region: u32,
    /// The number of its row of regions, counted on through all frames since reset.
    pub(super) row: u64,
    /// The edge at which the last of them came.
    pub(super) came: u64,
}

/// A region of one frame, judged.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Judged {
    /// Its number.
    pub(super) region: u32,
    /// The number of its row of regions, as of [`Complete`].
    pub(super) row: u64,
    /// The number of its frame since reset.
    pub(super) frame: u64,
    pub(super) verdict: Verdict,
    /// Its pixels as they were scored, row by row.
    pub(super) scored: Vec<u16>,
    /// Its pixels as they leave.
    pub(super) payload: Vec<u16>,
    /// The means of its blocks; none where irrelevant regions send none.
    pub(super) means: Vec<u16>,
    /// What was applied of the threshold that decides whether they leave.
    pub(super) summary_level: u32,
}

/// A region of one frame, decided.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Decided {
    pub(super) judged: Judged,
    pub(super) action: Action,
}

/// The regions that are judged and not yet decided, in order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Decisions {
    timing: RasterTiming,
    due: Due<Judged>,
    /// The first edge at which a second pass may begin: that after the pass before.
    pass_free: u64,
}

impl Decisions {
    pub(super) fn new(timing: RasterTiming) -> Self {
        Self { timing, due: Due::new(), pass_free: 0 }
    }

    pub(super) fn forget(&mut self) {
        self.due.clear();
        self.pass_free = 0;
    }

    /// Whether nothing waits for its decision.
    pub(super) fn is_empty(&self) -> bool {
        self.due.is_empty()
    }

    /// A region has been judged, whose last word has come to the tail at edge `came`.
    pub(super) fn push(&mut self, came: u64, judged: Judged) {
        let due = match self.timing.second_pass {
            None => came + u64::from(self.timing.decision_latency),
            Some(pass) => {
                let stored = came + u64::from(self.timing.store_latency);
                let first = self.pass_free.max(stored + u64::from(pass.after_store));
                let last = first + u64::from(self.timing.region_words) - 1;
                self.pass_free = last + 1;
                last + u64::from(pass.decision_latency)
            }
        };
        self.due.push_back((due, judged));
    }

    /// The region whose decision is on the ports after edge `now`.
    pub(super) fn step(&mut self, now: u64) -> Option<Judged> {
        take_due(&mut self.due, now)
    }
}
