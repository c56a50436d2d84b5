// SPDX-License-Identifier: MIT OR Apache-2.0
//! The figures of a frame: of each of its layers, and of all of them together
//! ([`FrameFigures`]). Means over the frames of a clip follow from them ([`mean_of_frames`]),
//! and frames whose outputs are not finite are counted ([`NotFiniteTally`]).

use super::computation::{Macs, PositionCounts, macs_of_layers, sum};
use super::cost::{FrameTraffic, TrafficTally};
use crate::cost::{FrameCost, NodeCosts};
use crate::summary::ClipSummary;
use crate::whole_frames::FrameAgreement;
use foveate_network::accelerator::LayerCost;
use foveate_network::{Executor, Network, NodeWork};

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

/// Returns a clip with the means of its counted frames.
pub(crate) fn clip_summary(
    name: &str,
    problem: Option<&String>,
    frames: &[FrameFigures],
) -> ClipSummary {
    let counted = counted_frames(frames);
    ClipSummary {
        name: name.to_owned(),
        frames: frames.len() as u64,
        counted_frames: counted.len() as u64,
        active_share: mean_of_frames(&counted, |frame| frame.active_share),
        changed_share: mean_of_frames(&counted, |frame| frame.changed_share),
        macs: Macs {
            whole_frame: mean_of_frames(&counted, |frame| frame.macs.whole_frame),
            needed: mean_of_frames(&counted, |frame| frame.macs.needed),
            scheduled: mean_of_frames(&counted, |frame| frame.macs.scheduled),
            whole_blocks: mean_of_frames(&counted, |frame| frame.macs.whole_blocks),
        },
        problem: problem.cloned(),
    }
}

/// The frames whose outputs are infinite or NaN.
#[derive(Clone, Debug, Default)]
pub(crate) struct NotFiniteTally {
    frames: u64,
    /// The clip and the number of the first such frame, and the first node with such a value in it.
    first: Option<(String, u64, usize)>,
}

impl NotFiniteTally {
    pub(crate) fn check_outputs(
        &mut self,
        (clip, frame): (&str, u64),
        network: &Network,
        executor: &Executor<'_>,
    ) {
        let is_odd = |value: usize| {
            !executor.tensor(value).real_values().iter().all(|value| value.is_finite())
        };
        if !network.outputs().iter().any(|&value| is_odd(value)) {
            return;
        }
        self.frames += 1;
        if self.first.is_none() {
            let node = (0..network.nodes().len()).find(|node| is_odd(node + 1));
            self.first = node.map(|node| (clip.to_owned(), frame, node));
        }
    }

    /// Returns a warning, if there is such a frame. A single clip is not named.
    pub(crate) fn warning(&self, network: &Network, is_one_clip: bool) -> Option<String> {
        let (clip, frame, node) = self.first.as_ref()?;
        let node = &network.nodes()[*node];
        let clip = if is_one_clip { String::new() } else { format!(" of `{clip}`") };
        Some(format!(
            "outputs hold values that are infinite or not a number in {} frames; in the first, frame {frame}{clip}, these begin at node `{}` ({})",
            self.frames,
            node.name(),
            node.operator_name()
        ))
    }
}
