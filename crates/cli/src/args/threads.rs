// SPDX-License-Identifier: MIT OR Apache-2.0
//! The number of threads that share the work of a command.

use std::env;
use std::thread::available_parallelism;

use clap::Args;
use foveate_simulator::MAX_THREADS;

use super::Command;
use crate::error::CliError;

/// The environment variable with the number of threads if `--threads` is not given. Rayon reads it,
/// too.
const THREADS_VARIABLE: &str = "RAYON_NUM_THREADS";

/// The option for the number of threads.
#[derive(Args, Debug)]
pub(crate) struct ThreadArgs {
    /// Number of threads that share the work, up to 256; 0 takes one per processor. It changes no
    /// result. The default is the value of RAYON_NUM_THREADS, or else one per processor
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
}

impl ThreadArgs {
    /// Starts the threads that share the work.
    ///
    /// # Errors
    /// Fails if the variable has no valid number, or if the system starts no threads.
    pub(crate) fn start(&self) -> Result<(), CliError> {
        let Some(threads) =
            self.threads.map_or_else(threads_from_environment, |threads| Ok(Some(threads)))?
        else {
            return Ok(());
        };
        let threads = match threads {
            0 => available_parallelism().map_or(1, usize::from),
            threads => threads,
        };
        let refused = |error| {
            CliError::Usage(format!(
                "the system cannot start {threads} threads: {error}; ask for fewer with --threads"
            ))
        };
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().map_err(refused)
    }
}

impl Command {
    /// Returns the option for the number of threads; `None` for a command that works in one thread.
    pub(crate) fn threads(&self) -> Option<&ThreadArgs> {
        match self {
            Self::Simulate(args) => Some(&args.threads),
            Self::Dataset(args) => Some(&args.threads),
            Self::Analyze(args) => Some(&args.threads),
            Self::Explore(args) => Some(&args.threads),
            Self::Fit(args) => Some(&args.threads),
            Self::Infer(args) => Some(&args.threads),
            Self::Stress(args) => Some(&args.threads),
            Self::Check(_)
            | Self::Decode(_)
            | Self::View(_)
            | Self::Live(_)
            | Self::Generate(_)
            | Self::Build(_)
            | Self::Cosim(_)
            | Self::Estimate(_)
            | Self::Explain(_)
            | Self::Link(_)
            | Self::Bench(_)
            | Self::Presets(_)
            | Self::Features(_)
            | Self::Completions(_)
            | Self::Man(_) => None,
        }
    }
}

/// Returns the number of threads in the environment variable, if it is set.
fn threads_from_environment() -> Result<Option<usize>, CliError> {
    let Some(text) = env::var_os(THREADS_VARIABLE).filter(|text| !text.is_empty()) else {
        return Ok(None);
    };
    let wrong =
        |right| CliError::Usage(format!("{THREADS_VARIABLE} is `{}`: {right}", text.display()));
    parse_threads(&text.to_string_lossy()).map(Some).map_err(wrong)
}

fn parse_threads(text: &str) -> Result<usize, String> {
    let threads = text.parse().ok().filter(|threads| *threads <= MAX_THREADS);
    threads
        .ok_or_else(|| format!("expected 1 to {MAX_THREADS}, or 0, which takes one per processor"))
}
