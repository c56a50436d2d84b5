// SPDX-License-Identifier: MIT OR Apache-2.0
//! What happens to a region, or to a row of regions, a fixed number of clocks after its words
//! have come ([`DueQueue`]). A decision follows the last word of a region at the tail, or its
//! second pass ([`DecisionQueue`]). The pixels of a row of regions are overwritten from the
//! edge on at which the first word of the row B further down is stored ([`RowStaleness`]).

use crate::region_decision::RegionDecision;
use foveate_camera::{RegionAction, RegionClass};
use foveate_design::RasterTiming;
use std::collections::VecDeque;

/// A region of one frame, all of whose words have come to the tail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CompletedRegion {
    pub(super) region: u32,
    /// The number of the row of regions, counted through all frames since reset.
    pub(super) row: u64,
    /// The edge at which the last word came.
    pub(super) completion_edge: u64,
    /// The class of the region in its frame. The region may be scored when frames already use
    /// another map.
    pub(super) class: RegionClass,
}

/// A region of one frame with its scores and relevance bits, before its decision is on the ports.
/// It is boxed, because it goes from queue to queue.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ScoredRasterRegion {
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

/// A queue of items with the edges at which they are due, in ascending order.
pub(super) type DueQueue<T> = VecDeque<(u64, T)>;

/// Removes and returns the item that is due at edge `now`, or returns `None`.
pub(super) fn take_due<T>(queue: &mut DueQueue<T>, now: u64) -> Option<T> {
    queue.front().filter(|(due, _)| *due == now)?;
    queue.pop_front().map(|(_, item)| item)
}

/// The rows of regions that have been stored, counted through all frames since reset.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RowStaleness {
    /// Clocks from the tail to the store, S.
    store_latency: u64,
    /// Rows of regions in the buffer, B.
    buffer_rows: u64,
    /// Edges in the future at which the first words of rows of regions are stored.
    due: VecDeque<u64>,
    /// Number of rows whose first word has been stored.
    stored_rows: u64,
    /// Number of rows whose first word has come to the tail.
    begun_rows: u64,
}

impl RowStaleness {
    pub(super) fn new(timing: &RasterTiming) -> Self {
        Self {
            store_latency: timing.store_latency.into(),
            buffer_rows: timing.buffer_rows.into(),
            due: VecDeque::new(),
            stored_rows: 0,
            begun_rows: 0,
        }
    }

    /// Resets the state: no row has been stored.
    pub(super) fn reset(&mut self) {
        self.due.clear();
        (self.stored_rows, self.begun_rows) = (0, 0);
    }

    /// Records the first word of a row of regions, which comes to the tail at edge `now`.
    pub(super) fn begin_row(&mut self, now: u64) {
        self.begun_rows += 1;
        self.due.push_back(now + self.store_latency);
    }

    /// Returns the number of the row of regions in the tail.
    pub(super) fn current_row(&self) -> u64 {
        self.begun_rows - 1
    }

    /// Returns the number of the first row that is not stale from the future edge `edge` on.
    pub(super) fn first_fresh_row_at(&self, edge: u64) -> u64 {
        let due = self.due.iter().take_while(|&&due| due <= edge).count();
        (self.stored_rows + due as u64).saturating_sub(self.buffer_rows)
    }

    /// Applies edge `now`, and returns the number of the first row that is not stale from it on.
    pub(super) fn step(&mut self, now: u64) -> u64 {
        while self.due.front().is_some_and(|&due| due <= now) {
            self.due.pop_front();
            self.stored_rows += 1;
        }
        self.stored_rows.saturating_sub(self.buffer_rows)
    }
}
