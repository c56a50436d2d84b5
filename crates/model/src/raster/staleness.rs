// SPDX-License-Identifier: MIT OR Apache-2.0
//! When the pixels of a region are overwritten: its row of regions is stale from the edge on at which the
//! first word of the row B further down is stored.

use std::collections::VecDeque;

use foveate_design::RasterTiming;

/// The rows of regions that have been stored, counted on through all frames since reset.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Staleness {
    /// S.
    store_latency: u64,
    /// B.
    buffer_rows: u64,
    /// Edges at which the first words of rows of regions are stored, that are not yet over.
    due: VecDeque<u64>,
    /// Rows of which the first word was stored.
    stored: u64,
    /// Rows of which the first word has come to the tail.
    begun: u64,
}

impl Staleness {
    pub(super) fn new(timing: &RasterTiming) -> Self {
        Self {
            store_latency: timing.store_latency.into(),
            buffer_rows: timing.buffer_rows.into(),
            due: VecDeque::new(),
            stored: 0,
            begun: 0,
        }
    }

    /// No row has been stored.
    pub(super) fn forget(&mut self) {
        self.due.clear();
        (self.stored, self.begun) = (0, 0);
    }

    /// The first word of a row of regions comes to the tail at edge `now`.
    pub(super) fn begin_row(&mut self, now: u64) {
        self.begun += 1;
        self.due.push_back(now + self.store_latency);
    }

    /// The number of the row of regions that is in the tail.
    pub(super) fn row(&self) -> u64 {
        self.begun - 1
    }

    /// Rows below this number will be stale from edge `edge` on, which is not over.
    pub(super) fn fresh_at(&self, edge: u64) -> u64 {
        let due = self.due.iter().take_while(|&&due| due <= edge).count();
        (self.stored + due as u64).saturating_sub(self.buffer_rows)
    }

    /// Edge `now` comes; rows below the number that is returned are stale from it on.
    pub(super) fn step(&mut self, now: u64) -> u64 {
        while self.due.front().is_some_and(|&due| due <= now) {
            self.due.pop_front();
            self.stored += 1;
        }
        self.stored.saturating_sub(self.buffer_rows)
    }
}
