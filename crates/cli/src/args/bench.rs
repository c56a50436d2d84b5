// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `foveate bench`.

use clap::Args;

use super::{DesignArgs, at_least_one};

/// Run the same frames through every level, from functional model to netlist, and print what each
/// costs
///
/// Every level runs on one thread and is compared with one above it; a mismatch ends with exit code
/// 1. If a tool is missing, its level is skipped.
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate bench
          foveate bench --preset serial --json
          foveate bench scene:street --netlist
          FOVEATE_CACHE=off foveate bench --markdown")]
pub(crate) struct BenchArgs {
    /// Frames to run: images, folders, globs, scene:NAME [default: random pixels]
    #[arg(value_name = "INPUT")]
    pub(crate) inputs: Vec<String>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Take at most this many frames of the inputs, or make this many random ones
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = at_least_one())]
    pub(crate) frames: u32,
    /// Seed of random pixels
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Time each level for at least this many seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 2.0, value_parser = parse_seconds)]
    pub(crate) seconds: f64,
    /// Also run the netlist that Yosys makes of one RPU, in Icarus
    #[arg(long)]
    pub(crate) netlist: bool,
    /// Print JSON
    #[arg(long, conflicts_with = "markdown")]
    pub(crate) json: bool,
    /// Print a Markdown table
    #[arg(long)]
    pub(crate) markdown: bool,
    /// Show no progress
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.0..=600.0).contains(seconds));
    seconds.ok_or_else(|| "expected seconds from 0 to 600, for example 2".to_owned())
}
