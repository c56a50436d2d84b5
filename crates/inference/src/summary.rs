// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run says at its end, and its tables.

use crate::closeness::Closeness;
use crate::cost::{Accelerated, Costs, FrameCost};
use crate::macs::Macs;
use crate::positions::Positions;
use crate::reference::Reference;
use crate::traffic::FrameTraffic;
use crate::{Framing, Mapping, Recorded, Sight};
use foveate_design::Config;
use foveate_network::{Executor, Form, Mode, Network};
use serde::Serialize;
use std::num::NonZeroU32;

/// A run of a network behind a camera. All shares and means are over the counted frames.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Version of this as JSON; changes when a field changes its meaning or goes.
    pub format_version: u32,
    /// The program.
    pub foveate_version: &'static str,
    /// Whether the inputs were read to their end.
    pub complete: bool,
    /// Why not.
    pub problem: Option<String>,
    /// What is odd: weights and outputs that are infinite or no numbers.
    pub warnings: Vec<String>,
    /// The inputs as they were named.
    pub inputs: Vec<String>,
    /// The network's file.
    pub network: String,
    /// In which layout the network's model takes its input: `nchw`, or `nhwc`, whose Transpose to channels first is left out.
    pub layout: &'static str,
    /// What was computed: `dense`, `exact`, `compare`, `truncate=0.1` or `fixed`.
    pub mode: String,
    /// How pixels became inputs.
    pub mapping: Mapping,
    /// How frames got the size of the network's input, as on the command line.
    pub framing: Framing,
    /// Width of the frames.
    pub width: u32,
    /// Height of the frames.
    pub height: u32,
    /// The network saw one of so many frames of the camera, the first one first.
    pub every: NonZeroU32,
    /// Frames that the network saw.
    pub frames: u64,
    /// Frames that are counted: all of a set, of a clip all but the first, which is computed whole.
    pub counted_frames: u64,
    /// Share of regions that were active.
    pub active_share: f64,
    /// Share of regions whose rendered pixels changed.
    pub changed_share: f64,
    /// Multiplications and additions of a frame, as means.
    pub macs: Macs,
    /// Bytes of all weights.
    pub weight_bytes: u64,
    /// Bytes of all tensors, which are kept from frame to frame.
    pub kept_bytes: u64,
    /// Bytes of the masks of all tensors, a bit per position.
    pub mask_bytes: u64,
    /// What all layers read and write for a frame.
    pub traffic: FrameTraffic,
    /// Mean time of a frame in this run in seconds.
    pub seconds_per_frame: f64,
    /// Of it the time beside operators: for masks, comparisons and copies.
    pub overhead_seconds_per_frame: f64,
    /// What a frame would cost on an accelerator, if one is named.
    pub accelerator: Option<Accelerated>,
    /// How far the outputs are from those of a whole computation, if one ran beside.
    pub error: Option<Error>,
    /// How the limits of the layers were chosen, if they were.
    pub tuning: Option<Tuning>,
    /// What the network loses behind the camera, if it ran on the whole frames, too.
    pub sight: Option<Sight>,
    /// The files of the outputs, if they are written.
    pub outputs: Vec<Recorded>,
    /// Every clip or set that is reported, in the order of the frames.
    pub clips: Vec<Clip>,
    /// Fingerprint of the design.
    pub design: String,
    /// The camera's configuration, with the frame size filled in.
    pub configuration: Config,
    /// Every layer.
    pub layers: Vec<Layer>,
}

/// A clip or set. All shares and means are over its counted frames.
#[derive(Clone, Debug, Serialize)]
pub struct Clip {
    /// Its name in tables and charts.
    pub name: String,
    /// Frames that were seen.
    pub frames: u64,
    /// Frames that are counted.
    pub counted_frames: u64,
    /// Share of regions that were active.
    pub active_share: f64,
    /// Share of regions whose rendered pixels changed.
    pub changed_share: f64,
    /// Multiplications and additions of a frame, as means.
    pub macs: Macs,
    /// Why frames are missing, if some are.
    pub problem: Option<String>,
}

/// A comparison with a whole computation.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Error {
    /// Frames with a tensor in which a value has other bits.
    pub different_frames: u64,
    /// How close the outputs are.
    #[serde(flatten)]
    pub outputs: Outputs,
    /// Mean time of a whole computation in this run in seconds.
    pub dense_seconds_per_frame: f64,
}

/// How close the outputs of all counted frames are to those of a whole computation.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Outputs {
    /// Share of frames in which every output has its largest value at the same place.
    pub agreement: f64,
    /// Cosine of the angle between all outputs as vectors.
    pub cosine: f64,
    /// Peak signal-to-noise ratio in decibels, with the range of the right outputs as the peak; nothing where they are equal.
    pub psnr: Option<f64>,
    /// The largest difference of an output.
    pub largest: f64,
    /// Root of the mean squared difference of the outputs, as a share of that of their values.
    pub relative_rms: f64,
    /// The same as a share of the standard deviation of the outputs over the frames of their clip: about 1 for outputs that never change.
    pub rms_of_variation: f64,
}

impl From<&Closeness> for Outputs {
    fn from(found: &Closeness) -> Self {
        let distance = &found.distance;
        Self {
            agreement: found.agreement(),
            cosine: distance.cosine(),
            psnr: distance.psnr(),
            largest: distance.largest,
            relative_rms: distance.relative(),
            rms_of_variation: found.of_variation(),
        }
    }
}

/// How the limits of the layers were chosen.
#[derive(Clone, Debug, Serialize)]
pub struct Tuning {
    /// What has to hold, as on the command line.
    pub goal: String,
    /// The clips whose frames it was tuned on: the first half of several, rounded up, or the only one, of which it was the first half.
    pub clips: Vec<String>,
    /// Counted frames of the first half, which it was tuned on. All else in the summary is of the second half.
    pub frames: u64,
    /// How often these frames were run.
    pub runs: u64,
    /// Nothing cut but what came out equal.
    pub exact: Tried,
    /// The same relative limit at every layer.
    pub uniform: Vec<Tried>,
    /// The limits that were chosen: those of the layers.
    pub chosen: Tried,
    /// The first frame alone, whose outputs stay. A goal that it reaches says nothing.
    pub frozen: Tried,
    /// Whether the second half reaches the goal, too.
    pub holds: bool,
}

impl Tuning {
    /// Said of a goal that frozen outputs reach.
    pub const SAYS_LITTLE: &'static str =
        "outputs that never change after the first frame reach it as well, so it says little";

    /// Everything that was tried, with what its limits are called, in the order of its table.
    pub(crate) fn tried(&self) -> impl Iterator<Item = (&'static str, Tried)> {
        let uniform = self.uniform.iter().map(|tried| ("uniform", *tried));
        let others = [("frozen", self.frozen), ("chosen", self.chosen)];
        [("exact", self.exact)].into_iter().chain(uniform).chain(others)
    }
}

/// What some limits gave on the first half.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Tried {
    /// As a share of the root mean square of each layer's values in the first frame, if it is the same at all layers and finite.
    pub relative_limit: Option<f64>,
    /// Share of the MACs whose windows hold a change.
    pub needed_share: f64,
    /// How close the outputs are.
    #[serde(flatten)]
    pub outputs: Outputs,
    /// Whether the goal is reached.
    pub holds: bool,
}

/// What one node did.
#[derive(Clone, Debug, Serialize)]
pub struct Layer {
    /// Its name in the model.
    pub name: String,
    /// Its operator.
    pub operator: String,
    /// Shape of its output.
    pub shape: Vec<usize>,
    /// Multiplications and additions for a whole frame.
    pub macs: u64,
    /// Share of the positions whose windows hold a change.
    pub needed_share: f64,
    /// Share of the positions that were computed; above 1 where whole blocks cover more than there is.
    pub scheduled_share: f64,
    /// Share of the positions that were passed on as changed.
    pub changed_share: f64,
    /// Bytes of its weights.
    pub weight_bytes: u64,
    /// Bytes of its output.
    pub output_bytes: u64,
    /// Bytes of the mask of its output, a bit per position.
    pub mask_bytes: u64,
    /// What it reads and writes for a frame.
    #[serde(flatten)]
    pub traffic: FrameTraffic,
    /// What it would cost on the accelerator, if one is named: computed whole.
    pub whole_cost: Option<FrameCost>,
    /// The same where the masks say.
    pub masked_cost: Option<FrameCost>,
    /// By how much a value must have changed to be passed on, in the modes that cut.
    pub limit: Option<f32>,
    /// Root of the mean squared difference from a whole computation, as a share of that of its values.
    pub relative_rms: Option<f64>,
}

/// What a mode is called on the command line.
pub(crate) fn mode_name(mode: Mode) -> String {
    match mode {
        Mode::Dense => "dense".to_owned(),
        Mode::Exact => "exact".to_owned(),
        Mode::Compare => "compare".to_owned(),
        Mode::Truncate(limit) => format!("truncate={limit}"),
        Mode::Fixed => "fixed".to_owned(),
    }
}

/// The layers from their sums.
pub(crate) fn layers(
    network: &Network,
    (sums, traffic): (&[Positions], &[FrameTraffic]),
    executor: &Executor<'_>,
    reference: Option<&Reference<'_>>,
    costs: Option<&Costs<'_>>,
) -> Vec<Layer> {
    let layer = |(node, sums): (usize, &Positions)| {
        let (place, form) = (&network.nodes()[node], network.form(node + 1));
        let cost = costs.map(|costs| costs.of_node(node));
        Layer {
            name: place.name().to_owned(),
            operator: place.kind().to_owned(),
            shape: form.shape().to_vec(),
            macs: network.macs(node),
            needed_share: sums.needed_share(),
            scheduled_share: sums.scheduled_share(),
            changed_share: sums.changed_share(),
            weight_bytes: place.weight_bytes(),
            output_bytes: form.bytes(),
            mask_bytes: mask_bytes(form),
            traffic: traffic[node],
            limit: executor.limit(node + 1),
            whole_cost: cost.map(|(whole, _)| whole),
            masked_cost: cost.map(|(_, masked)| masked),
            relative_rms: reference.map(|reference| reference.layers[node].relative()),
        }
    };
    sums.iter().enumerate().map(layer).collect()
}

/// Bytes of a mask.
pub(crate) fn mask_bytes(form: &Form) -> u64 {
    form.places().div_ceil(8) as u64
}

/// The comparison of the outputs.
pub(crate) fn error(reference: &Reference<'_>) -> Error {
    #[allow(clippy::cast_precision_loss, reason = "a mean")]
    let frames = reference.outputs.frames.max(1) as f64;
    Error {
        different_frames: reference.different,
        outputs: (&reference.outputs).into(),
        dense_seconds_per_frame: reference.seconds / frames,
    }
}

impl Summary {
    /// Said instead of shares where no frame counts.
    pub const ONLY_FRAME: &'static str =
        "the only frame was computed whole; savings begin with a second one";

    /// The share of the MACs of a whole computation, both in blocks, up to which parts are at least faster than the whole: that at which this run
    /// would have been as slow if each further block took as long as its own. It takes less, because more blocks are neighbors. Nothing without a
    /// whole computation, where nothing was computed, or where everything was.
    #[must_use]
    pub fn break_even_share(&self) -> Option<f64> {
        let dense = self.error?.dense_seconds_per_frame;
        let computing = self.seconds_per_frame - self.overhead_seconds_per_frame;
        let per_share = computing * self.macs.whole / self.macs.scheduled;
        let share = (dense - self.overhead_seconds_per_frame) / per_share;
        (share.is_finite() && self.macs.scheduled < self.macs.whole).then_some(share.min(1.0))
    }

    /// Whether limits were chosen on other clips than those that are reported, not on the first half of the only one.
    #[must_use]
    pub fn is_tuned_on_clips(&self) -> bool {
        let is_other = |name: &String| self.clips.iter().all(|clip| clip.name != *name);
        self.tuning.as_ref().is_some_and(|tuning| tuning.clips.iter().all(is_other))
    }
}
