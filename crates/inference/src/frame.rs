// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a frame did: each of its layers, and all of them together.

use crate::cost::{Costs, FrameCost};
use crate::macs::{Macs, macs};
use crate::positions::Positions;
use crate::sight::SightFrame;
use crate::sums::sum;
use crate::traffic::{FrameTraffic, Traffic};
use foveate_accelerator::Cost;
use foveate_network::{Executor, Network, Work};

/// What a layer did for a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LayerFrame {
    pub(crate) positions: Positions,
    pub(crate) traffic: Traffic,
    /// What it costs on the accelerator where it is needed, if one is named.
    pub(crate) cost: Option<Cost>,
}

/// A frame in numbers: what its table, the page and the charts say of it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frame {
    /// Its number among the frames of all clips, one after the other.
    pub(crate) place: u64,
    pub(crate) clip: String,
    /// Its number in its clip.
    pub(crate) number: u64,
    pub(crate) name: String,
    pub(crate) time_us: u64,
    /// Whether it is in the means.
    pub(crate) is_counted: bool,
    /// Share of regions that were active.
    pub(crate) active: f64,
    pub(crate) changed: f64,
    pub(crate) macs: Macs,
    pub(crate) traffic: FrameTraffic,
    pub(crate) seconds: f64,
    /// Of it the time beside operators.
    pub(crate) overhead: f64,
    pub(crate) relative_rms: Option<f64>,
    /// Beside the network on the whole frame, if that ran.
    pub(crate) sight: Option<SightFrame>,
    /// What a frame costs on the accelerator, if one is named, and what this one costs where it is needed.
    pub(crate) whole_cost: Option<FrameCost>,
    pub(crate) masked_cost: Option<FrameCost>,
}

impl LayerFrame {
    /// What every node did for the last frame.
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
    /// The same with what all its layers did together.
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

/// Those that are in the means.
pub(crate) fn counted(frames: &[Frame]) -> Vec<&Frame> {
    frames.iter().filter(|frame| frame.is_counted).collect()
}

/// The mean of some counted frames; 0 of none.
#[allow(clippy::cast_precision_loss, reason = "a mean")]
pub(crate) fn mean(frames: &[&Frame], of: fn(&Frame) -> f64) -> f64 {
    sum(frames.iter().map(|frame| of(frame))) / frames.len().max(1) as f64
}
