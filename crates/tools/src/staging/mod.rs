// SPDX-License-Identifier: MIT OR Apache-2.0
//! Folders and files that appear complete or not at all. They are written next to their place and
//! renamed when they are complete.
//!
//! A folder with contents is replaced only if the caller requests it, if the same kind of run wrote
//! it, and if every file in it is on the list of that run and unchanged. So the request cannot
//! delete other files. The leftovers of a killed process next to its output are removed when the
//! next process writes there.

mod continued_folder;
mod error;
mod file;
mod file_list;
mod folder;
mod growing_file;
mod scratch_folder;
mod space_reserve;

pub use continued_folder::ContinuedFolder;
pub use error::{StagingError, is_full};
pub use file::{check_file, write_file};
pub use folder::{FolderKind, StagedFolder};
pub use growing_file::GrowingFile;
pub use scratch_folder::{ScratchFolder, TEMPORARY_PREFIX};
pub use space_reserve::{SpaceReserve, has_room};

/// Returns the sorted names in a folder.
#[cfg(test)]
fn names_in(folder: &std::path::Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}
