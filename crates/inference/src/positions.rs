// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers of positions of a layer that were needed, computed and changed.

use crate::sums::ratio;
use foveate_network::Work;
use std::ops::AddAssign;

/// The positions of a node, summed over frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Positions {
    pub(crate) all: u64,
    pub(crate) needed: u64,
    pub(crate) scheduled: u64,
    pub(crate) changed: u64,
}

impl Positions {
    /// Returns the positions of one frame.
    pub(crate) fn of(work: &Work, places: usize) -> Self {
        Self {
            all: places as u64,
            needed: work.needed as u64,
            scheduled: work.scheduled as u64,
            changed: work.changed as u64,
        }
    }

    pub(crate) fn needed_share(&self) -> f64 {
        ratio(self.needed, self.all)
    }

    pub(crate) fn scheduled_share(&self) -> f64 {
        ratio(self.scheduled, self.all)
    }

    pub(crate) fn changed_share(&self) -> f64 {
        ratio(self.changed, self.all)
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
