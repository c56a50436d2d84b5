// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `explain`.

use clap::Args;

use super::DesignArgs;
use super::input::InputArgs;

/// Explain why a region of a frame was sent or dropped
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate explain street.mp4 --frame 3 --region 12,5
          foveate explain frames/ --frame 0 --region 0,0 --json")]
pub(crate) struct ExplainArgs {
    /// Inputs, as for `foveate simulate`: video, images, folders, globs, data sets, scene:NAME
    #[arg(value_name = "INPUT", required = true)]
    pub(crate) inputs: Vec<String>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Number of the frame, from 0; the frames before it are run first
    #[arg(long, value_name = "K")]
    pub(crate) frame: u64,
    /// Column and row of the region, from 0
    #[arg(long, value_name = "X,Y", value_parser = parse_region)]
    pub(crate) region: (u32, u32),
    /// Print JSON, with every pixel
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

fn parse_region(text: &str) -> Result<(u32, u32), String> {
    text.split_once(',')
        .and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)))
        .ok_or_else(|| "expected COLUMN,ROW, for example 12,5".to_owned())
}
