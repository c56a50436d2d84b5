// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summary of a run, and its tables.

use super::computation::{Macs, PositionCounts, WholeComputation};
use super::cost::FrameTraffic;
use crate::closeness::ClosenessTally;
use crate::cost::{AcceleratorSummary, FrameCost, NodeCosts};
use crate::{Computation, Framing, PixelMapping, RecordedOutput, WholeFrameAgreement};
use foveate_design::DesignConfig;
use foveate_network::{Executor, Network, TensorForm};
use serde::Serialize;
use std::num::NonZeroU32;

/// The summary of a run of a network behind a camera. All shares and means are over the counted
/// frames.
#[derive(Clone, Debug, Serialize)]
pub struct InferenceSummary {
    /// The version of this summary as JSON; it changes if a field changes its meaning or is
    /// removed.
    pub format_version: u32,
    /// The version of the program.
    pub foveate_version: &'static str,
    /// True if the inputs were read to their end.
    pub complete: bool,
    /// The reason if the inputs were not read to their end.
    pub problem: Option<String>,
    /// Warnings about weights and outputs that are infinite or NaN.
    pub warnings: Vec<String>,
    /// The inputs as the user named them.
    pub inputs: Vec<String>,
    /// The range of the luma of clips that are video: `coded` or `full`.
    pub luma: &'static str,
    /// The network's file.
    pub network: String,
    /// The layout in which the model takes its input: `nchw`, or `nhwc`, whose Transpose to
    /// channels first is left out.
    pub layout: &'static str,
    /// The computation, in JSON `dense`, `exact`, `compare`, `truncate=0.1`, `fixed`, or `tuned to`
    /// a goal.
    pub mode: Computation,
    /// The mapping from pixels to inputs.
    pub mapping: PixelMapping,
    /// The fit of frames to the size of the network's input, as on the command line.
    pub framing: Framing,
    /// The width of the frames in pixels.
    pub width: u32,
    /// The height of the frames in pixels.
    pub height: u32,
    /// The distance between the frames of the camera that the network saw; 1 if it saw all.
    pub every: NonZeroU32,
    /// The number of frames that the network saw.
    pub frames: u64,
    /// The number of counted frames: all frames of a data set, and all frames of a clip but the
    /// first, which is computed whole.
    pub counted_frames: u64,
    /// The share of regions that were active.
    pub active_share: f64,
    /// The share of regions whose rendered pixels changed.
    pub changed_share: f64,
    /// The mean multiplications and additions of a frame.
    pub macs: Macs,
    /// The size of all weights in bytes.
    pub weight_bytes: u64,
    /// The size in bytes of all tensors, which are kept from frame to frame.
    pub kept_bytes: u64,
    /// The size in bytes of the masks of all tensors, with one bit per position.
    pub mask_bytes: u64,
    /// The mean traffic of all layers for a frame.
    pub traffic: FrameTraffic,
    /// The mean time of a frame in this run in seconds.
    pub seconds_per_frame: f64,
    /// The mean time of a frame outside of operators in seconds: for masks, comparisons and copies.
    /// It is part of `seconds_per_frame`.
    pub overhead_seconds_per_frame: f64,
    /// The cost of a frame on an accelerator, if one is named.
    pub accelerator: Option<AcceleratorSummary>,
    /// The error of the outputs against a whole computation, if one ran.
    pub error: Option<WholeComputationError>,
    /// The choice of the limits of the layers, if they were tuned.
    pub tuning: Option<TuningSummary>,
    /// The loss of the network behind the camera, if it also ran on whole frames.
    pub sight: Option<WholeFrameAgreement>,
    /// The files of the outputs, if they are written.
    pub outputs: Vec<RecordedOutput>,
    /// The clips and data sets that are reported, in the order of the frames.
    pub clips: Vec<ClipSummary>,
    /// The fingerprint of the design.
    pub design: String,
    /// The configuration of the camera, with the frame size filled in.
    pub configuration: DesignConfig,
    /// The layers of the network.
    pub layers: Vec<LayerSummary>,
}

/// The figures of a clip or data set. All shares and means are over its counted frames.
#[derive(Clone, Debug, Serialize)]
pub struct ClipSummary {
    /// The name in tables and charts.
    pub name: String,
    /// The number of frames that the network saw.
    pub frames: u64,
    /// The number of counted frames.
    pub counted_frames: u64,
    /// The share of regions that were active.
    pub active_share: f64,
    /// The share of regions whose rendered pixels changed.
    pub changed_share: f64,
    /// The mean multiplications and additions of a frame.
    pub macs: Macs,
    /// The reason for missing frames, if some are missing.
    pub problem: Option<String>,
}

/// The comparison with a whole computation.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct WholeComputationError {
    /// The number of frames with a tensor in which some value has other bits.
    pub different_frames: u64,
    /// The closeness of the outputs.
    #[serde(flatten)]
    pub outputs: OutputCloseness,
    /// The mean time of a whole computation in this run in seconds.
    pub dense_seconds_per_frame: f64,
}

/// The closeness of the outputs of all counted frames to those of a whole computation.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct OutputCloseness {
    /// The share of frames in which every output has its largest value at the same position.
    pub agreement: f64,
    /// The cosine of the angle between all outputs as vectors.
    pub cosine: f64,
    /// The peak signal-to-noise ratio in decibels, with the range of the right outputs as the peak;
    /// `None` if the outputs are equal.
    pub psnr: Option<f64>,
    /// The largest difference of an output.
    pub largest: f64,
    /// The root mean squared difference of the outputs, as a share of the root mean square of their
    /// values.
    pub relative_rms: f64,
    /// The root mean squared difference of the outputs, as a share of their standard deviation over
    /// the frames of their clip: about 1 for outputs that never change.
    pub rms_of_variation: f64,
}

impl From<&ClosenessTally> for OutputCloseness {
    fn from(found: &ClosenessTally) -> Self {
        let distance = &found.distance;
        Self {
            agreement: found.agreement(),
            cosine: distance.cosine(),
            psnr: distance.psnr(),
            largest: distance.largest,
            relative_rms: distance.relative_rms(),
            rms_of_variation: found.rms_of_variation(),
        }
    }
}

/// The choice of the limits of the layers.
#[derive(Clone, Debug, Serialize)]
pub struct TuningSummary {
    /// The goal, as on the command line.
    pub goal: String,
    /// The clips whose frames it was tuned on: the first half of several clips, rounded up, or a
    /// single clip, whose first half it was tuned on.
    pub clips: Vec<String>,
    /// The number of counted frames that it was tuned on. All other values of the summary belong to
    /// the second half.
    pub frames: u64,
    /// The number of runs over the frames that it was tuned on.
    pub runs: u64,
    /// The trial with limits of 0, in which a value is passed on unless it equals the last one.
    pub exact: TuningTrial,
    /// The trials with the same relative limit at every layer.
    pub uniform: Vec<TuningTrial>,
    /// The trial with the chosen limits, one per layer.
    pub chosen: TuningTrial,
    /// The trial that computes only the first frame, so that the outputs stay the same. A goal that
    /// it reaches has little meaning.
    pub frozen: TuningTrial,
    /// True if the second half also reaches the goal.
    pub holds: bool,
}

impl TuningSummary {
    /// The sentence about a goal that frozen outputs reach.
    pub const FROZEN_OUTPUTS_NOTE: &'static str =
        "outputs that never change after the first frame reach it as well, so it says little";

    /// Returns all trials in the order of their table, each with the name of its kind of limits.
    pub(crate) fn named_trials(&self) -> impl Iterator<Item = (&'static str, TuningTrial)> {
        let uniform = self.uniform.iter().map(|tried| ("uniform", *tried));
        let others = [("frozen", self.frozen), ("chosen", self.chosen)];
        [("exact", self.exact)].into_iter().chain(uniform).chain(others)
    }
}

/// The result of some limits on the first half.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TuningTrial {
    /// The limit as a share of the root mean square of each layer's values in the first frame, if
    /// it is the same at all layers and finite.
    pub relative_limit: Option<f64>,
    /// The share of the MACs whose windows hold a change.
    pub needed_share: f64,
    /// The closeness of the outputs.
    #[serde(flatten)]
    pub outputs: OutputCloseness,
    /// True if the goal is reached.
    pub holds: bool,
}

/// The figures of one node.
#[derive(Clone, Debug, Serialize)]
pub struct LayerSummary {
    /// The name of the node in the model.
    pub name: String,
    /// The operator of the node.
    pub operator: String,
    /// The shape of the output.
    pub shape: Vec<usize>,
    /// The number of multiplications and additions for a whole frame.
    pub macs: u64,
    /// The share of the positions whose windows hold a change.
    pub needed_share: f64,
    /// The share of the positions that were computed; above 1 where whole blocks cover more than
    /// the output.
    pub scheduled_share: f64,
    /// The share of the positions that were passed on as changed.
    pub changed_share: f64,
    /// The size of the weights in bytes.
    pub weight_bytes: u64,
    /// The size of the output in bytes.
    pub output_bytes: u64,
    /// The size in bytes of the output's mask, with one bit per position.
    pub mask_bytes: u64,
    /// The mean traffic of the node for a frame.
    #[serde(flatten)]
    pub traffic: FrameTraffic,
    /// The cost of the whole node on the accelerator, if one is named.
    pub whole_cost: Option<FrameCost>,
    /// The cost of the node where the masks say, if an accelerator is named.
    pub masked_cost: Option<FrameCost>,
    /// The change that a value must exceed to be passed on, in the modes that have limits.
    pub limit: Option<f32>,
    /// The root mean squared difference from a whole computation, as a share of the root mean
    /// square of its values.
    pub relative_rms: Option<f64>,
}

/// Returns the layers with their figures.
pub(crate) fn layer_summaries(
    network: &Network,
    (sums, traffic): (&[PositionCounts], &[FrameTraffic]),
    executor: &Executor<'_>,
    reference: Option<&WholeComputation<'_>>,
    costs: Option<&NodeCosts<'_>>,
) -> Vec<LayerSummary> {
    let layer = |(node, sums): (usize, &PositionCounts)| {
        let (place, form) = (&network.nodes()[node], network.form(node + 1));
        let cost = costs.map(|costs| costs.mean_node_costs(node));
        LayerSummary {
            name: place.name().to_owned(),
            operator: place.operator_name().to_owned(),
            shape: form.shape().to_vec(),
            macs: network.macs(node),
            needed_share: sums.needed_share(),
            scheduled_share: sums.scheduled_share(),
            changed_share: sums.changed_share(),
            weight_bytes: place.weight_bytes(),
            output_bytes: form.bytes(),
            mask_bytes: mask_bytes(form),
            traffic: traffic[node],
            limit: executor.change_limit(node + 1),
            whole_cost: cost.map(|(whole, _)| whole),
            masked_cost: cost.map(|(_, masked)| masked),
            relative_rms: reference.map(|reference| reference.layers[node].relative_rms()),
        }
    };
    sums.iter().enumerate().map(layer).collect()
}

/// Returns the size of a mask in bytes.
pub(crate) fn mask_bytes(form: &TensorForm) -> u64 {
    form.position_count().div_ceil(8) as u64
}

/// Returns the comparison of the outputs with a whole computation.
pub(crate) fn whole_computation_error(reference: &WholeComputation<'_>) -> WholeComputationError {
    #[allow(clippy::cast_precision_loss, reason = "a mean")]
    let frames = reference.outputs.frames.max(1) as f64;
    WholeComputationError {
        different_frames: reference.different_frames,
        outputs: (&reference.outputs).into(),
        dense_seconds_per_frame: reference.seconds / frames,
    }
}

impl InferenceSummary {
    /// The sentence that replaces shares if no frame counts.
    pub const ONLY_FRAME_NOTE: &'static str =
        "the only frame was computed whole; savings begin with a second one";

    /// Returns the share of the MACs of a whole computation up to which this run is at least as
    /// fast as that computation. MACs are counted in whole blocks. The share is an estimate from
    /// below: it assumes that each further block takes as long as the blocks of this run, but more
    /// blocks would be neighbors, which take less time. Returns `None` if no whole computation ran,
    /// if nothing was computed, or if everything was computed.
    #[must_use]
    pub fn break_even_share(&self) -> Option<f64> {
        let dense = self.error?.dense_seconds_per_frame;
        let computing = self.seconds_per_frame - self.overhead_seconds_per_frame;
        let per_share = computing * self.macs.whole_blocks / self.macs.scheduled;
        let share = (dense - self.overhead_seconds_per_frame) / per_share;
        (share.is_finite() && self.macs.scheduled < self.macs.whole_blocks)
            .then_some(share.min(1.0))
    }

    /// Returns whether the limits were chosen on other clips than the reported ones, and not on the
    /// first half of a single clip.
    #[must_use]
    pub fn is_tuned_on_clips(&self) -> bool {
        let is_other = |name: &String| self.clips.iter().all(|clip| clip.name != *name);
        self.tuning.as_ref().is_some_and(|tuning| tuning.clips.iter().all(is_other))
    }
}
