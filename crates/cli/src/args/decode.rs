// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `decode`.

use std::path::PathBuf;

use clap::Args;

use super::DesignArgs;
use super::outputs::ReceiverOutputArgs;

/// Decode a recorded stream of region packets into the outputs that `simulate` makes of decisions
/// and pixels
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate decode packets.bin -o out --preset steady
          foveate decode packets.bin -o out --preset steady --events csv --rendered mkv
          cat packets.bin | foveate decode - -o out --preset steady")]
pub(crate) struct DecodeArgs {
    /// Stream of packets, such as packets.bin of `foveate simulate --packets`; - for standard input
    #[arg(value_name = "STREAM")]
    pub(crate) stream: PathBuf,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Folder to write
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Replace the folder if it holds a simulation
    #[arg(long)]
    pub(crate) force: bool,
    /// Print the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress and no summary
    #[arg(long, short)]
    pub(crate) quiet: bool,
    // The flattened group is last, because clap lists later options under its heading.
    #[command(flatten)]
    pub(crate) receiver: ReceiverOutputArgs,
}
