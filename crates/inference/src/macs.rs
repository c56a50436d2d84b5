// SPDX-License-Identifier: MIT OR Apache-2.0
//! Multiplications and additions (MACs) of a frame.

use crate::positions::Positions;
use crate::sums::{ratio, sum};
use foveate_network::Network;
use serde::Serialize;
use std::ops::AddAssign;

/// Multiplications and additions per frame.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Macs {
    /// Of a whole computation.
    pub dense: f64,
    /// Of the positions whose windows hold a change.
    pub needed: f64,
    /// Of the positions that were computed: whole blocks.
    pub scheduled: f64,
    /// Of the positions that a whole computation computes, in the same blocks.
    pub whole: f64,
}

impl Macs {
    /// Those that were needed as a share of a whole computation; 0 where there is nothing to compute.
    #[must_use]
    pub fn needed_share(&self) -> f64 {
        self.share(self.needed)
    }

    /// Those that were computed, as such a share.
    #[must_use]
    pub fn scheduled_share(&self) -> f64 {
        self.share(self.scheduled)
    }

    /// Those of a whole computation in blocks, as such a share.
    #[must_use]
    pub fn whole_share(&self) -> f64 {
        self.share(self.whole)
    }

    fn share(&self, some: f64) -> f64 {
        if self.dense == 0.0 { 0.0 } else { some / self.dense }
    }
}

impl AddAssign for Macs {
    fn add_assign(&mut self, other: Self) {
        self.dense += other.dense;
        self.needed += other.needed;
        self.scheduled += other.scheduled;
        self.whole += other.whole;
    }
}

/// The sums over all layers.
pub(crate) fn macs(network: &Network, sums: &[Positions]) -> Macs {
    #[allow(clippy::cast_precision_loss, reason = "a mean")]
    let of = |share: &dyn Fn(usize, &Positions) -> f64| {
        let layer = |(node, sums)| network.macs(node) as f64 * share(node, sums);
        sum(sums.iter().enumerate().map(layer))
    };
    let places = |node: usize| network.form(node + 1).places() as u64;
    Macs {
        dense: of(&|_, _| 1.0),
        needed: of(&|_, sums| sums.needed_share()),
        scheduled: of(&|_, sums| sums.scheduled_share()),
        whole: of(&|node, _| ratio(network.scheduled(node) as u64, places(node))),
    }
}
