// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `foveate stress`.

use std::path::PathBuf;

use clap::Args;

use super::DesignArgs;
use super::input::InputArgs;
use super::threads::ThreadArgs;

/// Run the hard cases of the arithmetic, or show a design disturbed clips
///
/// Without an input, prints the expected result, the observed result and the worst error of each
/// hard case. With inputs, shows them to the design as they are, with noise, compressed, with
/// flicker, a rising gain, saturation, shake, and as a still picture; and compares its decisions
/// and pixels with those of an ideal camera that sees the inputs as they are. A second table shows
/// where its flips without a disturbance come from.
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate stress --short
          foveate stress --markdown > stress.md
          foveate stress --config camera.toml street.mp4 --resize 224x224 --max-frames 60")]
pub(crate) struct StressArgs {
    /// Clips, as for `foveate simulate`, that a design is shown; several scenes are allowed
    #[arg(value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Configuration file of the task, which the ideal camera performs; preset `paper` without it
    #[arg(long, value_name = "FILE", requires = "inputs")]
    pub(crate) task: Option<PathBuf>,
    /// Take seconds instead of minutes: the same cases with fewer frames, regions and widths
    #[arg(long, conflicts_with = "inputs")]
    pub(crate) short: bool,
    /// Print JSON
    #[arg(long, conflicts_with = "markdown")]
    pub(crate) json: bool,
    /// Print a Markdown table
    #[arg(long)]
    pub(crate) markdown: bool,
    /// Show no progress
    #[arg(long, short)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

impl StressArgs {
    /// Returns true if a design is given, which needs a clip.
    pub(crate) fn has_design(&self) -> bool {
        let DesignArgs { config, preset, overrides } = &self.design;
        config.is_some() || preset.is_some() || !overrides.is_empty()
    }
}
