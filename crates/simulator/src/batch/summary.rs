// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a batch says of itself and of every clip.

use serde::Serialize;

use crate::Summary;
use foveate_footage::{Clip, shown_input};

/// Changes when a key of the summary changes its meaning or goes.
pub(super) const FORMAT_VERSION: u32 = 1;

/// One clip of a batch.
#[derive(Clone, Debug, Serialize)]
pub struct ClipSummary {
    /// What was simulated.
    pub inputs: Vec<String>,
    /// Its class, if the inputs are a labelled tree.
    pub label: Option<String>,
    /// Its folder in the output; none if it failed.
    pub output: Option<String>,
    /// Whether it was run to its end.
    pub complete: bool,
    /// Why it was not.
    pub problem: Option<String>,
    /// Frames.
    pub frames: u64,
    /// Share of regions with SRS and TRS.
    pub active_share: Option<f64>,
    /// Pixels of all frames.
    pub pixels_in: u64,
    /// Pixels of all active regions.
    pub pixels_forwarded: u64,
}

/// The summary of a batch, `summary.json` at the top of its folder.
#[derive(Clone, Debug, Serialize)]
pub struct BatchSummary {
    /// Version of this format.
    pub format_version: u32,
    /// Version of the program.
    pub foveate_version: &'static str,
    /// Whether every clip was run to its end.
    pub complete: bool,
    /// Why not.
    pub problem: Option<String>,
    /// Frames of all clips.
    pub frames: u64,
    /// Every clip, in order.
    pub clips: Vec<ClipSummary>,
}

impl ClipSummary {
    pub(super) fn done(clip: &Clip, summary: Summary) -> Self {
        Self {
            output: Some(clip.place.display().to_string()),
            complete: summary.complete,
            problem: summary.problem,
            frames: summary.frames,
            active_share: Some(summary.active_share),
            pixels_in: summary.pixels_in,
            pixels_forwarded: summary.pixels_forwarded,
            ..Self::failed(clip, String::new())
        }
    }

    pub(super) fn failed(clip: &Clip, problem: String) -> Self {
        Self {
            inputs: clip.inputs.iter().map(|input| shown_input(input)).collect(),
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
