// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summary of a batch and of every clip in it.

use serde::Serialize;

use crate::RunSummary;
use foveate_media::{BatchClip, input_without_secrets};

/// The version of the format. It changes when a key of the summary changes its meaning or is
/// removed.
pub(super) const FORMAT_VERSION: u32 = 1;

/// The summary of one clip of a batch.
#[derive(Clone, Debug, Serialize)]
pub struct ClipSummary {
    /// The inputs that were simulated.
    pub inputs: Vec<String>,
    /// The class of the clip, if the inputs are a labelled tree.
    pub label: Option<String>,
    /// The folder of the clip in the output, or `None` if the clip failed.
    pub output: Option<String>,
    /// The clip was run to its end.
    pub complete: bool,
    /// The reason why the clip is not complete.
    pub problem: Option<String>,
    /// The number of frames.
    pub frames: u64,
    /// The share of active regions.
    pub active_share: Option<f64>,
    /// The number of pixels of all frames.
    pub pixels_in: u64,
    /// The number of pixels of all active regions.
    pub pixels_forwarded: u64,
}

/// The summary of a batch, the file `summary.json` at the top of its folder.
#[derive(Clone, Debug, Serialize)]
pub struct BatchSummary {
    /// The version of this format.
    pub format_version: u32,
    /// The version of the program.
    pub foveate_version: &'static str,
    /// Every clip was run to its end.
    pub complete: bool,
    /// The reason why the batch is not complete.
    pub problem: Option<String>,
    /// The number of frames of all clips.
    pub frames: u64,
    /// The summaries of all clips, in order.
    pub clips: Vec<ClipSummary>,
}

impl ClipSummary {
    pub(super) fn of_finished_clip(clip: &BatchClip, summary: RunSummary) -> Self {
        Self {
            output: Some(clip.output_folder.display().to_string()),
            complete: summary.complete,
            problem: summary.problem,
            frames: summary.frames,
            active_share: Some(summary.active_share),
            pixels_in: summary.pixels_in,
            pixels_forwarded: summary.pixels_forwarded,
            ..Self::of_failed_clip(clip, String::new())
        }
    }

    pub(super) fn of_failed_clip(clip: &BatchClip, problem: String) -> Self {
        Self {
            inputs: clip.inputs.iter().map(|input| input_without_secrets(input)).collect(),
            label: clip.label.clone(),
            output: None,
            complete: false,
            problem: Some(problem),
            frames: 0,
            active_share: None,
            pixels_in: 0,
            pixels_forwarded: 0,
        }
    }
}
