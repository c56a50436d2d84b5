// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate explore` in units of work for several machines. Synthesis is no part of a unit, so that
//! Yosys is not needed.

use std::path::Path;

use foveate_explore::{ExploreError, Request, measure_unit, plan};

use super::Terminal;
use crate::args::ExploreArgs;
use crate::error::CliError;
use crate::output;

/// Prints one unit per line, as compact JSON.
pub(super) fn print_plan(
    request: &Request<'_>,
    folder: &Path,
    terminal: &Terminal,
) -> Result<(), CliError> {
    let units = plan(request, folder, terminal);
    terminal.shown.finish();
    let lines = units?.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>();
    let lines =
        lines.map_err(|error| CliError::Usage(format!("cannot write the plan: {error}")))?;
    output::text(&lines.iter().map(|line| format!("{line}\n")).collect::<String>())
}

pub(super) fn measure(
    args: &ExploreArgs,
    request: &Request<'_>,
    unit: &str,
    folder: &Path,
    terminal: &Terminal,
) -> Result<(), CliError> {
    let done = measure_unit(request, unit, folder, terminal);
    terminal.shown.finish();
    let done = match done {
        Err(ExploreError::Cancelled) => {
            return Err(CliError::Interrupted { path: folder.to_owned() });
        }
        Err(error @ ExploreError::Broken { .. }) => {
            return Err(CliError::Failed(error.to_string()));
        }
        other => other?,
    };
    if args.json {
        output::json(&done)
    } else if args.quiet {
        Ok(())
    } else {
        output::text(&format!(
            "{}: {} designs over {}\n",
            done.file,
            done.combinations.len(),
            done.clip
        ))
    }
}
