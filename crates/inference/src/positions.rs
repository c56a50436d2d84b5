// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers of positions of a layer that were needed, computed and changed.

use crate::sums::share;
use foveate_network::NodeWork;
use std::ops::AddAssign;

/// The positions of a node, summed over frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PositionCounts {
    pub(crate) all: u64,
    pub(crate) needed: u64,
    pub(crate) scheduled: u64,
    pub(crate) changed: u64,
}

impl PositionCounts {
    /// Returns the positions of one frame.
    pub(crate) fn from_work(work: &NodeWork, places: usize) -> Self {
        Self {
            all: places as u64,
            needed: work.needed_positions as u64,
            scheduled: work.scheduled_positions as u64,
            changed: work.changed_positions as u64,
        }
    }

    pub(crate) fn needed_share(&self) -> f64 {
        share(self.needed, self.all)
    }

    pub(crate) fn scheduled_share(&self) -> f64 {
        share(self.scheduled, self.all)
    }

    pub(crate) fn changed_share(&self) -> f64 {
        share(self.changed, self.all)
    }
}

impl AddAssign for PositionCounts {
    fn add_assign(&mut self, other: Self) {
        self.all += other.all;
        self.needed += other.needed;
        self.scheduled += other.scheduled;
        self.changed += other.changed;
    }
}
