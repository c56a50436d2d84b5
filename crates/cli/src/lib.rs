// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `foveate` command, for its program and for the Python package, which contains the same
//! command. This is the only crate that prints.
//!
//! Exit codes: 0 fine, 1 a mismatch or a failed check, 2 bad usage or input, 3 a tool is missing or
//! failed, 128 plus the number of the signal after a request to stop: 130 after Ctrl-C, 143 after
//! SIGTERM.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "this crate is the one that prints")]

mod agreement_text;
mod args;
mod command;
mod error;
mod interrupt;
mod liberty;
mod notice;
mod output;
mod progress;
mod serving;

use std::ffi::OsString;

use args::{Cli, Command};
use clap::{CommandFactory, FromArgMatches};
use foveate_media::InputWarnings;
use foveate_tools::end_all_process_families;

/// Runs the command with these words, of which the first is its name, and returns its exit code.
/// The process listens for signals from then on, so this is for processes that do nothing else.
#[must_use]
pub fn run(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    let cli = match parse(&words) {
        Ok(cli) => cli,
        Err(error) => {
            notice::print_usage(&error);
            return u8::try_from(error.exit_code()).expect("clap ends with 0 or 2");
        }
    };
    let result = run_command(&cli, &words);
    InputWarnings::of_process().take().iter().for_each(|warning| notice::print_warning(warning));
    let code = match result {
        Ok(()) => 0,
        Err(error) => {
            notice::print_notice(&error);
            error.exit_code()
        }
    };
    // A thread that still waits for a tool does not end that tool.
    end_all_process_families();
    code
}

/// Parses the words. Two readers of standard input are an error.
fn parse(words: &[OsString]) -> Result<Cli, clap::Error> {
    let mut command = Cli::command();
    let matches = command.try_get_matches_from_mut(words)?;
    args::refuse_second_reader(&mut command, &matches)?;
    Cli::from_arg_matches(&matches).map_err(|error| error.format(&mut command))
}

fn run_command(cli: &Cli, words: &[OsString]) -> Result<(), error::CliError> {
    interrupt::listen()?;
    if let Some(threads) = cli.command.threads() {
        threads.start()?;
    }
    match &cli.command {
        Command::Check(args) => command::check::run(args),
        Command::Generate(args) => command::generate::run(args),
        Command::Build(args) => command::build::run(args),
        Command::Cosim(args) => command::cosim::run(args),
        Command::Estimate(args) => command::estimate::run(args),
        Command::Simulate(args) => command::simulate::run(args),
        Command::Dataset(args) => command::dataset::run(args),
        Command::Decode(args) => command::decode::run(args),
        Command::View(args) => command::view::run(args),
        Command::Live(args) => command::live::run(args),
        Command::Explain(args) => command::explain::run(args),
        Command::Analyze(args) => command::analyze::run(args),
        Command::Explore(args) => command::explore::run(args),
        Command::Fit(args) => command::fit::run(args),
        Command::Infer(args) => command::infer::run(args, words),
        Command::Link(args) => command::link::run(args),
        Command::Stress(args) => command::stress::run(args),
        Command::Bench(args) => command::bench::run(args),
        Command::Presets(args) => command::presets::run(args),
        Command::Features(args) => command::features::run(args),
        Command::Completions(args) => command::completions::run(args),
        Command::Man(args) => command::man::run(args),
    }
}
