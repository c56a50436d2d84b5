// SPDX-License-Identifier: MIT OR Apache-2.0
//! The times at which the pixels of a region are overwritten. A row of regions is stale from the
//! edge on at which the first word of the row B further down is stored.

use std::collections::VecDeque;

use foveate_design::RasterTiming;

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
