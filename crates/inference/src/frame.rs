// SPDX-License-Identifier: MIT OR Apache-2.0
//! The figures of a frame: of each of its layers, and of all of them together.

use crate::cost::{Costs, FrameCost};
use crate::macs::{Macs, macs};
use crate::positions::Positions;
use crate::sight::SightFrame;
use crate::sums::sum;
use crate::traffic::{FrameTraffic, Traffic};
use foveate_accelerator::Cost;
use foveate_network::{Executor, Network, Work};

/// The figures of a layer for a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LayerFrame {
    pub(crate) positions: Positions,
    pub(crate) traffic: Traffic,
    /// The cost on the accelerator where the layer is needed, if an accelerator is named.
    pub(crate) cost: Option<Cost>,
}

/// The figures of a frame for its table, the page and the charts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frame {
    /// The number of the frame among the frames of all clips, one after the other.
    pub(crate) place: u64,
    pub(crate) clip: String,
    /// The number of the frame in its clip.
    pub(crate) number: u64,
    pub(crate) name: String,
    pub(crate) time_us: u64,
    /// Whether the frame is part of the means.
    pub(crate) is_counted: bool,
    /// The share of regions that were active.
    pub(crate) active: f64,
    pub(crate) changed: f64,
    pub(crate) macs: Macs,
    pub(crate) traffic: FrameTraffic,
    pub(crate) seconds: f64,
    /// The time outside of operators in seconds; it is part of `seconds`.
    pub(crate) overhead: f64,
    pub(crate) relative_rms: Option<f64>,
    /// The comparison with the network on the whole frame, if that ran.
    pub(crate) sight: Option<SightFrame>,
    /// The cost of a whole frame on the accelerator, if one is named; `masked_cost` is the cost of
    /// this frame where it is needed.
    pub(crate) whole_cost: Option<FrameCost>,
    pub(crate) masked_cost: Option<FrameCost>,
}

impl LayerFrame {
    /// Returns the figures of every node for the last frame.
    pub(crate) fn all(
        network: &Network,
        executor: &Executor<'_>,
        work: &[Work],
        costs: Option<&Costs<'_>>,
    ) -> Vec<Self> {
        let of = |(node, work): (usize, &Work)| Self {
            positions: Positions::of(work, network.form(node + 1).places()),
            traffic: Traffic::of(network, executor, node),
            cost: costs.map(|costs| costs.of_frame(executor, node)),
        };
        work.iter().enumerate().map(of).collect()
    }
}

impl Frame {
    /// Adds the sums over all layers to the frame.
    pub(crate) fn of_layers(
        self,
        network: &Network,
        layers: &[LayerFrame],
        costs: Option<&Costs<'_>>,
    ) -> Self {
        let mut moved = Traffic::default();
        layers.iter().for_each(|layer| moved += layer.traffic);
        let masked: Option<Cost> = layers.iter().map(|layer| layer.cost).sum();
        Self {
            macs: macs(network, &layers.iter().map(|layer| layer.positions).collect::<Vec<_>>()),
            traffic: moved.mean(1),
            whole_cost: costs.map(Costs::whole),
            masked_cost: costs.zip(masked).map(|(costs, cost)| costs.mean(cost, 1)),
            ..self
        }
    }
}

/// Returns the frames that are part of the means.
pub(crate) fn counted(frames: &[Frame]) -> Vec<&Frame> {
    frames.iter().filter(|frame| frame.is_counted).collect()
}

/// Returns the mean of a figure over some frames; 0 without frames.
#[allow(clippy::cast_precision_loss, reason = "a mean")]
pub(crate) fn mean(frames: &[&Frame], of: fn(&Frame) -> f64) -> f64 {
    sum(frames.iter().map(|frame| of(frame))) / frames.len().max(1) as f64
}
