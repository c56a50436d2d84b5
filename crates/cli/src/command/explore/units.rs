// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate explore` in units of work for several machines. Synthesis is no part of a unit, so that
//! Yosys is not needed.

use std::path::Path;

use foveate_explore::{ExploreError, ExploreRequest, measure_unit, plan_units};
use foveate_media::PlaybackError;

use crate::args::ExploreArgs;
use crate::error::CliError;
use crate::output;
use crate::progress::RunTerminal;

/// Prints one unit per line, as compact JSON.
pub(super) fn print_plan(
    request: &ExploreRequest<'_>,
    folder: &Path,
    terminal: &RunTerminal,
) -> Result<(), CliError> {
    let units = plan_units(request, folder, terminal);
    terminal.progress.finish();
    let lines = units?.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>();
    let lines =
        lines.map_err(|error| CliError::Usage(format!("cannot write the plan: {error}")))?;
    output::print_text(&lines.iter().map(|line| format!("{line}\n")).collect::<String>())
}

pub(super) fn run_unit(
    args: &ExploreArgs,
    request: &ExploreRequest<'_>,
    unit: &str,
    folder: &Path,
    terminal: &RunTerminal,
) -> Result<(), CliError> {
    let done = measure_unit(request, unit, folder, terminal);
    terminal.progress.finish();
    let done = match done {
        Err(ExploreError::Playback(PlaybackError::Interrupted)) => {
            return Err(CliError::Interrupted { path: folder.to_owned() });
        }
        Err(error @ ExploreError::IncompleteClip { .. }) => {
            return Err(CliError::Failed(error.to_string()));
        }
        other => other?,
    };
    output::print_result((args.json, args.quiet), &done, || {
        format!("{}: {} designs over {}\n", done.file, done.combinations.len(), done.clip)
    })
}
