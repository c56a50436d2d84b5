// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `foveate` command. The only crate that prints or exits.
//!
//! Exit codes: 0 fine, 1 a mismatch or a failed check, 2 bad usage or input, 3 a tool is missing or
//! failed, 128 and the number of the signal when it was told to stop: 130 after Ctrl-C, 143 after SIGTERM.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "this crate is the one that prints")]

mod args;
mod command;
mod error;
mod hint;
mod interrupt;
mod output;
mod progress;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::try_parse().unwrap_or_else(|error| hint::with_hint(error).exit());
    match run(&cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("foveate: {error}");
            error.exit_code()
        }
    }
}

fn run(cli: &Cli) -> Result<(), error::CliError> {
    match &cli.command {
        Command::Check(args) => command::check::run(args),
        Command::Generate(args) => command::generate::run(args),
        Command::Cosim(args) => command::cosim::run(args),
        Command::Estimate(args) => command::estimate::run(args),
        Command::Simulate(args) => command::simulate::run(args),
        Command::Dataset(args) => command::dataset::run(args),
        Command::Explain(args) => command::explain::run(args),
        Command::Analyze(args) => command::analyze::run(args),
        Command::Explore(args) => command::explore::run(args),
        Command::Fit(args) => command::fit::run(args),
        Command::Infer(args) => command::infer::run(args),
        Command::Link(args) => command::link::run(args),
        Command::Stress(args) => command::stress::run(args),
        Command::Bench(args) => command::bench::run(args),
        Command::Presets(args) => command::presets::run(args),
        Command::Completions(args) => command::completions::run(args),
    }
}
