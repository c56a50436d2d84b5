// SPDX-License-Identifier: MIT OR Apache-2.0
//! How many positions of a layer were needed, were computed and changed.

use foveate_network::Work;
use std::ops::AddAssign;

/// Positions of a node over all counted frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Positions {
    pub(crate) all: u64,
    pub(crate) needed: u64,
    pub(crate) scheduled: u64,
    pub(crate) changed: u64,
}

impl Positions {
    /// Of a frame.
    pub(crate) fn of(work: &Work, places: usize) -> Self {
        Self {
            all: places as u64,
            needed: work.needed as u64,
            scheduled: work.scheduled as u64,
            changed: work.changed as u64,
        }
    }
}

impl AddAssign for Positions {
    fn add_assign(&mut self, other: Self) {
        self.all += other.all;
        self.needed += other.needed;
        self.scheduled += other.scheduled;
        self.changed += other.changed;
    }
}
