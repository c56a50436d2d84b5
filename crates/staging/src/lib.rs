// SPDX-License-Identifier: MIT OR Apache-2.0
//! Folders and files that appear complete or not at all. They are written beside their place and
//! renamed when they are complete.
//!
//! A folder with contents is replaced only if the caller asks for it, if the same kind of run wrote it,
//! and if it holds nothing else. So a flag cannot delete other files.

mod error;
mod file;
mod folder;
mod growing;
mod list;
mod reserve;

pub use error::StagingError;
pub use file::{TEMPORARY, check_file, write_file};
pub use folder::{Kind, StagedFolder};
pub use growing::GrowingFile;
pub use reserve::Reserve;
