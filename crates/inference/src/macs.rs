// SPDX-License-Identifier: MIT OR Apache-2.0
//! The multiplications and additions (MACs) of a frame.

use crate::positions::PositionCounts;
use crate::sums::{share, sum};
use foveate_network::Network;
use serde::Serialize;
use std::ops::AddAssign;

/// The number of multiplications and additions (MACs) per frame.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Macs {
    /// The MACs of a whole computation.
    #[serde(rename = "dense")]
    pub whole_frame: f64,
    /// The MACs of the positions whose windows hold a change.
    pub needed: f64,
    /// The MACs of the positions that were computed, in whole blocks.
    pub scheduled: f64,
    /// The MACs of the positions that a whole computation computes, in the same blocks.
    #[serde(rename = "whole")]
    pub whole_blocks: f64,
}

impl Macs {
    /// Returns the needed MACs as a share of a whole computation; 0 if there is nothing to compute.
    #[must_use]
    pub fn needed_share(&self) -> f64 {
        self.share(self.needed)
    }

    /// Returns the computed MACs as a share of a whole computation; 0 if there is nothing to
    /// compute.
    #[must_use]
    pub fn scheduled_share(&self) -> f64 {
        self.share(self.scheduled)
    }

    /// Returns the MACs of a whole computation in blocks, as a share of a whole computation; 0 if
    /// there is nothing to compute.
    #[must_use]
    pub fn whole_share(&self) -> f64 {
        self.share(self.whole_blocks)
    }

    fn share(&self, some: f64) -> f64 {
        if self.whole_frame == 0.0 { 0.0 } else { some / self.whole_frame }
    }
}

impl AddAssign for Macs {
    fn add_assign(&mut self, other: Self) {
        self.whole_frame += other.whole_frame;
        self.needed += other.needed;
        self.scheduled += other.scheduled;
        self.whole_blocks += other.whole_blocks;
    }
}

pub(crate) fn macs_of_layers(network: &Network, sums: &[PositionCounts]) -> Macs {
    #[allow(clippy::cast_precision_loss, reason = "a mean")]
    let of = |share: &dyn Fn(usize, &PositionCounts) -> f64| {
        let layer = |(node, sums)| network.macs(node) as f64 * share(node, sums);
        sum(sums.iter().enumerate().map(layer))
    };
    let places = |node: usize| network.form(node + 1).position_count() as u64;
    Macs {
        whole_frame: of(&|_, _| 1.0),
        needed: of(&|_, sums| sums.needed_share()),
        scheduled: of(&|_, sums| sums.scheduled_share()),
        whole_blocks: of(&|node, _| share(network.scheduled_positions(node) as u64, places(node))),
    }
}
