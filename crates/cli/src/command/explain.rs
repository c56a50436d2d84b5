// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate explain`: why a region was sent or dropped.

use foveate_media::{ClipPlayer, ImageRelation};
use foveate_simulator::explain_region;

use crate::args::{ExplainArgs, refuse_several_clips, warn_about_inputs};
use crate::error::CliError;
use crate::output;

pub(crate) fn run(args: &ExplainArgs) -> Result<(), CliError> {
    let config = args.design.config()?;
    let options = args.input.options(ImageRelation::Clip);
    refuse_several_clips(&args.inputs, &options)?;
    let player = ClipPlayer::open(&args.inputs, &config.camera, &options)?;
    warn_about_inputs(&args.inputs, &options);
    let explanation = explain_region(&config, player, args.frame, args.region)?;
    output::print_result((args.json, false), &explanation, || explanation.to_string())
}
