// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads the libraries of a process.

use std::path::{Path, PathBuf};

use foveate_estimate::{LibertyLibrary, check_libraries};
use foveate_explore::TargetProcess;

use crate::args::{DEFAULT_LIBERTY, ProcessArgs};
use crate::error::CliError;

/// Reads a library of cells. A missing file of the default library is explained.
pub(crate) fn read_library(path: &Path) -> Result<LibertyLibrary, CliError> {
    if path == Path::new(DEFAULT_LIBERTY) && !path.exists() {
        return Err(CliError::Usage(format!(
            "there is no `{DEFAULT_LIBERTY}`; `apt-get install qflow-tech-osu018` has it, or name the liberty \
             file of another process"
        )));
    }
    Ok(LibertyLibrary::read(path)?)
}

/// Reads libraries of memory macros.
pub(crate) fn read_macros(paths: &[PathBuf]) -> Result<Vec<LibertyLibrary>, CliError> {
    Ok(paths.iter().map(|path| LibertyLibrary::read(path)).collect::<Result<_, _>>()?)
}

/// Reads the process of the options, if there is one. Faults of its libraries are found here,
/// before a long run.
pub(crate) fn read_process(args: &ProcessArgs) -> Result<Option<TargetProcess>, CliError> {
    let Some(path) = &args.liberty else { return Ok(None) };
    let library = read_library(path)?;
    let macros = read_macros(&args.macros)?;
    check_libraries(&library, &macros)?;
    Ok(Some(TargetProcess { library, macros, memory_limit: args.memory_limit }))
}
