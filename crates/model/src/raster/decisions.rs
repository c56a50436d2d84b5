// SPDX-License-Identifier: MIT OR Apache-2.0
//! The delay of decisions: a fixed number of clocks after the last word of a region has come to the
//! tail, or after its second pass.

use foveate_camera::{RegionAction, RegionClass};
use foveate_design::RasterTiming;

use super::due_queue::{DueQueue, take_due};
use crate::region_decision::RegionDecision;

/// A region of one frame, all of whose words have come to the tail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CompletedRegion {
    /// The number of the region.
    pub(super) region: u32,
    /// The number of the row of regions, counted through all frames since reset.
    pub(super) row: u64,
    /// The edge at which the last word came.
    pub(super) completion_edge: u64,
    /// The class of the region in its frame. The region may be scored when frames already use
    /// another map.
    pub(super) class: RegionClass,
}

/// A region of one frame with its scores and relevance bits, before its decision is on the ports. It
/// is boxed, because it goes from queue to queue.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ScoredRasterRegion {
    /// The number of the region.
    pub(super) region: u32,
    /// The number of the row of regions, counted through all frames since reset.
    pub(super) row: u64,
    /// The number of the frame since reset.
    pub(super) frame: u64,
    pub(super) decision: RegionDecision,
    /// The scored pixels in row-major order.
    pub(super) scored: Vec<u16>,
    /// The pixels that the region forwards if it is active.
    pub(super) payload: Vec<u16>,
    /// The means of the blocks of the region. They are empty if irrelevant regions send none.
    pub(super) means: Vec<u16>,
    /// The threshold of summaries that was applied when the region was scored.
    pub(super) summary_level: u32,
}

/// A region of one frame with its action.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DecidedRasterRegion {
    pub(super) scored_region: Box<ScoredRasterRegion>,
    pub(super) action: RegionAction,
}

/// The regions that are scored and not yet decided, in order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DecisionQueue {
    timing: RasterTiming,
    due: DueQueue<Box<ScoredRasterRegion>>,
    /// The first edge at which a second pass may begin, after the pass before.
    next_pass: u64,
}

impl DecisionQueue {
    pub(super) fn new(timing: RasterTiming) -> Self {
        Self { timing, due: DueQueue::new(), next_pass: 0 }
    }

    pub(super) fn reset(&mut self) {
        self.due.clear();
        self.next_pass = 0;
    }

    /// Returns true if no region waits for its decision.
    pub(super) fn is_empty(&self) -> bool {
        self.due.is_empty()
    }

    /// Appends a scored region, whose last word came to the tail at edge `came`.
    pub(super) fn push(&mut self, came: u64, scored_region: Box<ScoredRasterRegion>) {
        let due = match self.timing.second_pass {
            None => came + u64::from(self.timing.decision_latency),
            Some(pass) => {
                let stored = came + u64::from(self.timing.store_latency);
                let first = self.next_pass.max(stored + u64::from(pass.after_store));
                let last = first + u64::from(self.timing.region_words) - 1;
                self.next_pass = last + 1;
                last + u64::from(pass.decision_latency)
            }
        };
        self.due.push_back((due, scored_region));
    }

    /// Returns the region whose decision is on the ports after edge `now`, or `None`.
    pub(super) fn step(&mut self, now: u64) -> Option<Box<ScoredRasterRegion>> {
        take_due(&mut self.due, now)
    }
}
