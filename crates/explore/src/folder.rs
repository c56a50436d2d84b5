// SPDX-License-Identifier: MIT OR Apache-2.0
//! The folder of an exploration and the file that marks it, also if several machines write to it.

use crate::ExploreError;
use foveate_tools::{ContinuedFolder, TEMPORARY_PREFIX, write_file};
use std::fs;
use std::path::Path;

pub(crate) const MARK_FILE: &str = "exploration.json";

/// The content of the mark before the exploration is complete.
pub(crate) const UNFINISHED_MARK: &str = "{ \"finished\": false }\n";

/// The folder of the files that mark finished units.
pub(crate) const UNITS_FOLDER: &str = "units";

/// Checks that a folder is an exploration, is empty or does not exist. It reads only the folder's
/// entries.
///
/// # Errors
/// Fails if the folder holds something else.
pub fn check_folder(output: &Path) -> Result<(), ExploreError> {
    // A workflow creates the folder of the files that it waits for.
    let foreign = |entry: fs::DirEntry| {
        let name = entry.file_name();
        name != UNITS_FOLDER && !name.to_string_lossy().starts_with(TEMPORARY_PREFIX)
    };
    let occupied = fs::read_dir(output).is_ok_and(|entries| entries.flatten().any(foreign));
    // Other processes that create the folder write the mark first, so the mark exists if any of
    // their files was seen.
    if occupied && !output.join(MARK_FILE).is_file() || output.is_file() {
        return Err(ExploreError::OtherFolder { path: output.to_owned() });
    }
    Ok(())
}

/// Makes the folder an exploration, unless it holds something else.
pub(crate) fn claim_folder(output: &Path) -> Result<(), ExploreError> {
    check_folder(output)?;
    fs::create_dir_all(output).map_err(ExploreError::io("make the folder", output))?;
    if output.join(MARK_FILE).is_file() { Ok(()) } else { write_mark(output, UNFINISHED_MARK) }
}

/// Opens the folder; only files of the exploration are overwritten in it.
pub(crate) fn open_continued(output: &Path) -> Result<ContinuedFolder, ExploreError> {
    let mut folder = ContinuedFolder::open(output)?;
    folder.add_expected(MARK_FILE, UNFINISHED_MARK.as_bytes());
    Ok(folder)
}

/// Marks the exploration as unfinished. Returns true if it was complete.
pub(crate) fn replace_mark(output: &Path) -> Result<bool, ExploreError> {
    let path = output.join(MARK_FILE);
    let old = foveate_tools::read_bytes(&path, UNFINISHED_MARK.len() as u64);
    write_mark(output, UNFINISHED_MARK)?;
    // A complete description is longer than the mark.
    Ok(old.is_err())
}

fn write_mark(output: &Path, text: &str) -> Result<(), ExploreError> {
    Ok(write_file(&output.join(MARK_FILE), text.as_bytes())?)
}
