// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate explain`: why a region was sent or dropped.

use foveate_footage::{ImagesAs, open};
use foveate_simulator::explain;

use crate::args::{ExplainArgs, warn_of};
use crate::error::CliError;
use crate::output;

pub(crate) fn run(args: &ExplainArgs) -> Result<(), CliError> {
    let config = args.design.read()?;
    let options = args.input.options(ImagesAs::Clip);
    let source = open(&args.inputs, &config.camera, &options)?;
    warn_of(&args.inputs, &options);
    let explanation = explain(&config, source, args.frame, args.region)?;
    if args.json { output::json(&explanation) } else { output::text(&explanation.to_string()) }
}
