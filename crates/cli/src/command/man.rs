// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate man`: the manual pages.

use std::fs;

use clap::CommandFactory;
use foveate_tools::{ScratchFolder, write_file};

use crate::args::{Cli, ManArgs};
use crate::error::CliError;

pub(crate) fn run(args: &ManArgs) -> Result<(), CliError> {
    let folder = &args.output;
    fs::create_dir_all(folder).map_err(CliError::io("make the folder", folder))?;
    let failed = || CliError::io("write manual pages into", folder);
    let made = ScratchFolder::new().map_err(failed())?;
    clap_mangen::generate_to(Cli::command().disable_help_subcommand(true), made.path())
        .map_err(failed())?;
    for entry in fs::read_dir(made.path()).map_err(failed())? {
        let entry = entry.map_err(failed())?;
        let page = fs::read(entry.path()).map_err(failed())?;
        write_file(&folder.join(entry.file_name()), &page)?;
    }
    Ok(())
}
