// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run computes of a network ([`Computation`]), and how much that is: positions of
//! layers that were needed, computed and changed ([`PositionCounts`]), and multiplications and
//! additions ([`Macs`]). A [`WholeComputation`] computes every frame wholly, for a comparison.

use crate::TuningGoal;
use crate::closeness::ClosenessTally;
use foveate_network::vision::OutputDistance;
use foveate_network::{ExecutionMode, Executor, Mask, Network, NodeWork};
use serde::{Serialize, Serializer};
use std::fmt;
use std::ops::AddAssign;
use std::time::Instant;

/// The computation for each frame after the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Computation {
    /// The computation of a mode.
    Mode(ExecutionMode),
    /// A computation of the changes above a limit for each layer. The limits are chosen on the
    /// first half of the clips, rounded up, or on the first half of the frames of a single clip.
    /// The second half is reported.
    Tuned(TuningGoal),
}

/// Writes `dense`, `exact`, `compare`, `truncate=0.1`, `fixed`, or `tuned to` a goal. A mode is
/// written as on the command line.
impl fmt::Display for Computation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mode(ExecutionMode::Dense) => f.write_str("dense"),
            Self::Mode(ExecutionMode::Exact) => f.write_str("exact"),
            Self::Mode(ExecutionMode::Compare) => f.write_str("compare"),
            Self::Mode(ExecutionMode::Truncate(limit)) => write!(f, "truncate={limit}"),
            Self::Mode(ExecutionMode::Fixed) => f.write_str("fixed"),
            Self::Tuned(goal) => write!(f, "tuned to {goal}"),
        }
    }
}

/// Serializes the text that `Display` writes.
impl Serialize for Computation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A whole computation that runs next to the compared one.
pub(crate) struct WholeComputation<'a> {
    network: &'a Network,
    dense: Executor<'a>,
    full_mask: Mask,
    /// The distance of every node's output.
    pub(crate) layers: Vec<OutputDistance>,
    pub(crate) outputs: ClosenessTally,
    /// The number of frames in which some value of some tensor has other bits.
    pub(crate) different_frames: u64,
    pub(crate) seconds: f64,
}

impl<'a> WholeComputation<'a> {
    pub(crate) fn new(network: &'a Network) -> Self {
        Self {
            network,
            dense: Executor::new(network, ExecutionMode::Dense),
            full_mask: Mask::full(network.input().height(), network.input().width()),
            layers: vec![OutputDistance::default(); network.nodes().len()],
            outputs: ClosenessTally::default(),
            different_frames: 0,
            seconds: 0.0,
        }
    }

    /// Computes the frame whole, compares every tensor, and returns how close the outputs are. Only
    /// a counted frame is part of the means.
    pub(crate) fn compare(
        &mut self,
        picture: &[f32],
        other: &Executor<'_>,
        is_counted: bool,
    ) -> ClosenessTally {
        let start = Instant::now();
        self.dense.step(picture, &self.full_mask);
        let seconds = start.elapsed().as_secs_f64();
        let mut is_different = false;
        for (node, layer) in self.layers.iter_mut().enumerate() {
            let (distance, differs) = OutputDistance::between(
                &self.dense.tensor(node + 1).real_values(),
                &other.tensor(node + 1).real_values(),
            );
            if is_counted {
                layer.add(distance);
            }
            is_different |= differs;
        }
        let outputs = ClosenessTally::compare_outputs(
            self.network,
            |value| self.dense.tensor(value).real_values(),
            other,
        );
        self.different_frames += u64::from(is_different);
        if is_counted {
            self.outputs.add(&outputs);
            self.seconds += seconds;
        }
        outputs
    }
}

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

/// Returns a sum; 0 for no values, where the sum of the standard library is -0.
pub(crate) fn sum(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |sum, value| sum + value)
}

/// Returns a share; 0 if `all` is 0.
#[allow(clippy::cast_precision_loss, reason = "a share")]
pub(crate) fn share(part: u64, all: u64) -> f64 {
    if all == 0 { 0.0 } else { part as f64 / all as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_is_written_as_on_the_command_line() {
        for text in ["dense", "exact", "compare", "truncate=0.25", "fixed"] {
            let computation = Computation::Mode(crate::parse_mode(text).unwrap());
            assert_eq!(serde_json::to_value(computation).unwrap(), text);
        }
        let tuned = Computation::Tuned(TuningGoal::Psnr(40.0));
        assert_eq!(tuned.to_string(), "tuned to psnr=40");
    }
}
