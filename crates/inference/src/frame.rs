// SPDX-License-Identifier: MIT OR Apache-2.0
//! The figures of a frame: of each of its layers, and of all of them together.

use crate::cost::{FrameCost, NodeCosts};
use crate::macs::{Macs, macs_of_layers};
use crate::positions::PositionCounts;
use crate::sums::sum;
use crate::traffic::{FrameTraffic, TrafficTally};
use crate::whole_frames::FrameAgreement;
use foveate_network::{Executor, Network, NodeWork, accelerator::LayerCost};

#[derive(Clone, Copy, Debug)]
pub(crate) struct LayerFigures {
    pub(crate) positions: PositionCounts,
    pub(crate) traffic: TrafficTally,
    /// The cost on the accelerator where the layer is needed, if an accelerator is named.
    pub(crate) cost: Option<LayerCost>,
}

/// The figures of a frame for its table, the page and the charts.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrameFigures {
    /// The number of the frame among the frames of all clips, one after the other.
    pub(crate) index_in_run: u64,
    pub(crate) clip: String,
    /// The number of the frame in its clip.
    pub(crate) number: u64,
    pub(crate) name: String,
    pub(crate) time_us: u64,
    /// True if the frame is part of the means.
    pub(crate) is_counted: bool,
    /// The share of regions that were active.
    pub(crate) active_share: f64,
    pub(crate) changed_share: f64,
    pub(crate) macs: Macs,
    pub(crate) traffic: FrameTraffic,
    pub(crate) seconds: f64,
    /// The time outside of operators in seconds; it is part of `seconds`.
    pub(crate) overhead_seconds: f64,
    pub(crate) relative_rms: Option<f64>,
    /// The comparison with the network on the whole frame, if that ran.
    pub(crate) whole_frame_agreement: Option<FrameAgreement>,
    /// The cost of a whole frame on the accelerator, if one is named; `masked_cost` is the cost of
    /// this frame where it is needed.
    pub(crate) whole_cost: Option<FrameCost>,
    pub(crate) masked_cost: Option<FrameCost>,
}

impl LayerFigures {
    /// Returns the figures of every node for the last frame.
    pub(crate) fn of_all_nodes(
        network: &Network,
        executor: &Executor<'_>,
        work: &[NodeWork],
        costs: Option<&NodeCosts<'_>>,
    ) -> Vec<Self> {
        let of = |(node, work): (usize, &NodeWork)| Self {
            positions: PositionCounts::from_work(work, network.form(node + 1).position_count()),
            traffic: TrafficTally::of_node(network, executor, node),
            cost: costs.map(|costs| costs.node_cost_of_frame(executor, node)),
        };
        work.iter().enumerate().map(of).collect()
    }
}

impl FrameFigures {
    /// Adds the sums over all layers to the frame.
    pub(crate) fn with_layers(
        self,
        network: &Network,
        layers: &[LayerFigures],
        costs: Option<&NodeCosts<'_>>,
    ) -> Self {
        let mut moved = TrafficTally::default();
        layers.iter().for_each(|layer| moved += layer.traffic);
        let masked: Option<LayerCost> = layers.iter().map(|layer| layer.cost).sum();
        Self {
            macs: macs_of_layers(
                network,
                &layers.iter().map(|layer| layer.positions).collect::<Vec<_>>(),
            ),
            traffic: moved.mean(1),
            whole_cost: costs.map(NodeCosts::whole_frame_cost),
            masked_cost: costs.zip(masked).map(|(costs, cost)| costs.mean_cost(cost, 1)),
            ..self
        }
    }
}

/// Returns the frames that are part of the means.
pub(crate) fn counted_frames(frames: &[FrameFigures]) -> Vec<&FrameFigures> {
    frames.iter().filter(|frame| frame.is_counted).collect()
}

/// Returns the mean of a figure over some frames; 0 without frames.
#[allow(clippy::cast_precision_loss, reason = "a mean")]
pub(crate) fn mean_of_frames(frames: &[&FrameFigures], of: fn(&FrameFigures) -> f64) -> f64 {
    sum(frames.iter().map(|frame| of(frame))) / frames.len().max(1) as f64
}
