// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `foveate stress`.

use clap::Args;

use super::threads::ThreadArgs;

/// Run the hard cases, and print the expected result, the observed result and the worst error of
/// each
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate stress --short
          foveate stress --markdown > stress.md")]
pub(crate) struct StressArgs {
    /// Take seconds instead of minutes: the same cases with fewer frames, regions and widths
    #[arg(long)]
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
}
