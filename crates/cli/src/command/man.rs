// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate man`: the manual pages.

use std::fs;

use clap::CommandFactory;

use crate::args::{Cli, ManArgs};
use crate::error::CliError;

pub(crate) fn run(args: &ManArgs) -> Result<(), CliError> {
    let folder = &args.output;
    fs::create_dir_all(folder).map_err(CliError::io("make the folder", folder))?;
    clap_mangen::generate_to(Cli::command().disable_help_subcommand(true), folder)
        .map_err(CliError::io("write manual pages into", folder))
}
