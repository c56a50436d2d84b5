// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a frame did: each of its layers, and all of them together as a row of the table of frames.

use crate::camera::Seen;
use crate::cost::{Costs, FrameCost};
use crate::macs::{Macs, macs};
use crate::positions::Positions;
use crate::traffic::Traffic;
use foveate_accelerator::Cost;
use foveate_files::tables::{Cell, Cells};
use foveate_network::{Executor, Network, Work};

/// What a layer did for a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LayerFrame {
    pub(crate) positions: Positions,
    pub(crate) traffic: Traffic,
    /// What it costs on the accelerator where it is needed, if one is named.
    pub(crate) cost: Option<Cost>,
}

/// A frame in numbers.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub(crate) number: u64,
    /// Whether it is in the means.
    pub(crate) is_counted: bool,
    /// Shares of the regions.
    pub(crate) active: f64,
    pub(crate) changed: f64,
    pub(crate) macs: Macs,
    pub(crate) seconds: f64,
    pub(crate) relative_rms: Option<f64>,
    pub(crate) layers: Vec<LayerFrame>,
}

impl Frame {
    /// What every node did for the last frame.
    pub(crate) fn layers(
        network: &Network,
        executor: &Executor<'_>,
        work: &[Work],
        costs: Option<&Costs<'_>>,
    ) -> Vec<LayerFrame> {
        let of = |(node, work): (usize, &Work)| LayerFrame {
            positions: Positions::of(work, network.form(node + 1).places()),
            traffic: Traffic::of(network, executor, node),
            cost: costs.map(|costs| costs.of_frame(executor, node)),
        };
        work.iter().enumerate().map(of).collect()
    }

    /// Multiplications and additions.
    pub(crate) fn macs(network: &Network, layers: &[LayerFrame]) -> Macs {
        macs(network, &layers.iter().map(|layer| layer.positions).collect::<Vec<_>>())
    }

    /// Its row. What was added to the table later stands at the end.
    pub(crate) fn row(&self, clip: &str, seen: Seen<'_>, costs: Option<&Costs<'_>>) -> Cells {
        let mut moved = Traffic::default();
        self.layers.iter().for_each(|layer| moved += layer.traffic);
        let traffic = moved.mean(1);
        let masked: Option<Cost> = self.layers.iter().map(|layer| layer.cost).sum();
        let masked = costs.zip(masked).map(|(costs, cost)| costs.mean(cost, 1));
        let whole = costs.map(Costs::whole);
        let real = |value: f64| Cell::Real(Some(value));
        let of = |cost: Option<FrameCost>, of: fn(FrameCost) -> f64| Cell::Real(cost.map(of));
        [
            ("frame", Cell::Count(Some(self.number))),
            ("name", Cell::Text(seen.name.to_owned())),
            ("t_us", Cell::Count(Some(seen.time_us))),
            ("active_share", real(self.active)),
            ("changed_share", real(self.changed)),
            ("macs_dense", real(self.macs.dense)),
            ("macs_needed", real(self.macs.needed)),
            ("macs_scheduled", real(self.macs.scheduled)),
            ("read_bytes", real(traffic.read_bytes)),
            ("halo_bytes", real(traffic.halo_bytes)),
            ("written_bytes", real(traffic.written_bytes)),
            ("seconds", real(self.seconds)),
            ("relative_rms", Cell::Real(self.relative_rms)),
            ("clip", Cell::Text(clip.to_owned())),
            ("counted", Cell::Flag(self.is_counted)),
            ("whole_latency_seconds", of(whole, |cost| cost.seconds)),
            ("latency_seconds", of(masked, |cost| cost.seconds)),
            ("whole_energy_mj", of(whole, |cost| cost.energy_mj)),
            ("energy_mj", of(masked, |cost| cost.energy_mj)),
        ]
        .map(|(name, cell)| (name.to_owned(), cell))
        .into()
    }
}
