// SPDX-License-Identifier: MIT OR Apache-2.0
//! The edges from which on rows of regions are stale. Rows are counted through all frames since
//! reset.

use std::collections::VecDeque;

use crate::delivery::NEVER;

/// The edges at which the first words of rows of regions are stored.
#[derive(Debug)]
pub(super) struct RowStaleness {
    /// The rows of regions in the buffer, B.
    buffer_rows: u64,
    /// The number of the first row whose edge is kept.
    first_row: u64,
    edges: VecDeque<u64>,
}

impl RowStaleness {
    pub(super) fn new(buffer_rows: u64) -> Self {
        Self { buffer_rows, first_row: 0, edges: VecDeque::new() }
    }

    /// Resets the state: no row has been stored.
    pub(super) fn reset(&mut self) {
        self.edges.clear();
        self.first_row = 0;
    }

    /// Records the edge at which the first word of the next row is stored.
    pub(super) fn push_row(&mut self, edge: u64) {
        self.edges.push_back(edge);
    }

    /// Returns the edge from which on a row is stale, as far as it is known: the first word of the
    /// row B further down is stored at that edge.
    pub(super) fn stale_from(&self, row: u64) -> u64 {
        let place = (row + self.buffer_rows).checked_sub(self.first_row);
        let place = place.expect("edges are kept while a region of their rows waits");
        let edge = usize::try_from(place).ok().and_then(|place| self.edges.get(place));
        edge.copied().unwrap_or(NEVER)
    }

    /// Drops the edges that no row from `row` on needs.
    pub(super) fn drop_before(&mut self, row: u64) {
        while self.first_row < row + self.buffer_rows && self.edges.pop_front().is_some() {
            self.first_row += 1;
        }
    }
}
