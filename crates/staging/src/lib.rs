// SPDX-License-Identifier: MIT OR Apache-2.0
//! Folders and files that are there whole or not at all: written beside their place and renamed when
//! they are complete.
//!
//! A folder that holds something is only replaced when the caller asks for it, and only when it is
//! one that the caller's kind of run wrote, and holds nothing else: nobody's thesis goes because of a flag.

mod error;
mod file;
mod folder;
mod list;
mod reserve;

pub use error::StagingError;
pub use file::{check_file, write_file};
pub use folder::{Kind, StagedFolder};
pub use reserve::Reserve;
