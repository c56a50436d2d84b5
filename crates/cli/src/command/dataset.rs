// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate dataset`: a set of images in, the set of their active regions out. The command is a
//! simulation that writes the set instead of pictures.

use foveate_media::ImageRelation;
use foveate_simulator::RunOptions;

use super::simulate::{SimulationJob, run_job};
use crate::args::DatasetArgs;
use crate::error::CliError;

pub(crate) fn run(args: &DatasetArgs) -> Result<(), CliError> {
    run_job(&SimulationJob {
        inputs: &args.inputs,
        config: args.design.config()?,
        // Images are a set by default, because this command is for sets.
        input: args.input.options(ImageRelation::Set),
        output: &args.output,
        options: RunOptions {
            rendered: None,
            data_set: true,
            overwrite: args.force,
            ..RunOptions::default()
        },
        json: args.json,
        quiet: args.quiet,
    })
}
