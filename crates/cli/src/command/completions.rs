// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate completions`: a completion script for a shell.

use clap::CommandFactory;

use crate::args::{Cli, CompletionsArgs};
use crate::error::CliError;
use crate::output;

pub(crate) fn run(args: &CompletionsArgs) -> Result<(), CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "foveate", &mut script);
    output::print_text(&String::from_utf8_lossy(&script))
}
