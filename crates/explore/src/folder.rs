// SPDX-License-Identifier: MIT OR Apache-2.0
//! The folder of an exploration: what marks it, also while several machines write to it.

use std::fs;
use std::path::Path;

use foveate_staging::{ContinuedFolder, TEMPORARY, write_file};

use crate::ExploreError;

/// The file that marks a folder as an exploration and describes it.
pub(crate) const MARK: &str = "exploration.json";
/// What the mark holds until all is there.
pub(crate) const UNFINISHED: &str = "{ \"finished\": false }\n";
/// The folder of the files that say which units are done.
pub(crate) const UNITS: &str = "units";

/// Refuses a folder that holds something else than an exploration. Nothing is read but the folder.
///
/// # Errors
/// When it does.
pub fn check_folder(output: &Path) -> Result<(), ExploreError> {
    // A workflow makes the folder of the files that it waits for.
    let foreign = |entry: fs::DirEntry| {
        let name = entry.file_name();
        name != UNITS && !name.to_string_lossy().starts_with(TEMPORARY)
    };
    let occupied = fs::read_dir(output).is_ok_and(|entries| entries.flatten().any(foreign));
    // Who else makes the folder writes the mark first, so it is there if anything was seen.
    if occupied && !output.join(MARK).is_file() || output.is_file() {
        return Err(ExploreError::Occupied { path: output.to_owned() });
    }
    Ok(())
}

/// Makes the folder an exploration, unless it is something else.
pub(crate) fn claim(output: &Path) -> Result<(), ExploreError> {
    check_folder(output)?;
    fs::create_dir_all(output).map_err(ExploreError::io("make the folder", output))?;
    if output.join(MARK).is_file() { Ok(()) } else { mark(output, UNFINISHED) }
}

/// The folder, of which only files that are its own are written again.
pub(crate) fn continued(output: &Path) -> Result<ContinuedFolder, ExploreError> {
    let mut folder = ContinuedFolder::open(output)?;
    folder.expect(MARK, UNFINISHED.as_bytes());
    Ok(folder)
}

/// Describes the exploration.
pub(crate) fn mark(output: &Path, text: &str) -> Result<(), ExploreError> {
    Ok(write_file(&output.join(MARK), text.as_bytes())?)
}
