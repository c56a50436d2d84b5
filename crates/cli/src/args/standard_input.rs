// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check that a configuration from standard input leaves it to no other argument.

use clap::error::ErrorKind;
use clap::{ArgMatches, Command, Error};

/// The arguments of frames and packets, which are read from standard input if they are `-`.
const STREAMS: [&str; 4] = ["inputs", "input", "stream", "clip"];

/// The arguments of a configuration.
const CONFIGS: [&str; 2] = ["config", "file"];

/// Refuses `--config -` beside frames or packets from standard input, because the configuration
/// would leave nothing for them.
pub(crate) fn refuse_second_reader(
    command: &mut Command,
    matches: &ArgMatches,
) -> Result<(), Error> {
    let Some((name, given)) = matches.subcommand() else { return Ok(()) };
    let is_standard_input = |id: &str| {
        let mut values = given.try_get_raw(id).ok().flatten().into_iter().flatten();
        values.any(|value| value == "-")
    };
    let any_is = |ids: &[&str]| ids.iter().any(|id| is_standard_input(id));
    if !any_is(&CONFIGS) || !any_is(&STREAMS) {
        return Ok(());
    }
    let command = command.find_subcommand_mut(name).expect("this subcommand was parsed");
    let problem = "standard input can be read only once, so `--config -` and `-` exclude each other; write the \
                   configuration into a file and name that";
    Err(command.error(ErrorKind::ArgumentConflict, problem))
}
