// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate explain`: why a region was sent or dropped.

use foveate_simulator::{FrameRate, InputOptions, explain, open};

use crate::args::ExplainArgs;
use crate::error::CliError;
use crate::output;

pub(crate) fn run(args: &ExplainArgs) -> Result<(), CliError> {
    let config = args.design.read()?;
    let input = InputOptions { frames: args.frames, frame_rate: FrameRate::new(args.fps, 1)? };
    let source = open(&args.inputs, &config, &input)?;
    let explanation = explain(&config, source, args.frame, args.region)?;
    if args.json { output::json(&explanation) } else { output::text(&explanation.to_string()) }
}
