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
mod leftovers;
mod locked_folder;
mod scratch_folder;
mod space_reserve;

pub use continued_folder::ContinuedFolder;
pub use error::{StagingError, is_full};
pub use file::{check_file, write_file};
pub use folder::{FolderKind, StagedFolder};
pub use growing_file::GrowingFile;
pub use leftovers::TEMPORARY_PREFIX;
pub use scratch_folder::ScratchFolder;
pub use space_reserve::{SpaceReserve, has_room};
