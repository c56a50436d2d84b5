// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder for intermediate results among the temporary files.

use std::ffi::OsStr;
use std::io;
use std::path::Path;

use crate::staging::leftovers::{SCRATCH_PREFIX, remove_leftovers_once};
use crate::staging::locked_folder::LockedFolder;

/// A temporary folder that is removed when it is dropped. The folder of a killed process is removed
/// when the next one is created.
#[derive(Debug)]
pub struct ScratchFolder(LockedFolder);

impl ScratchFolder {
    /// Creates the folder in the system's folder of temporary files.
    ///
    /// # Errors
    /// Fails if that folder cannot be written.
    pub fn new() -> io::Result<Self> {
        let parent = std::env::temp_dir();
        remove_leftovers_once(&parent);
        LockedFolder::create(&parent, OsStr::new(SCRATCH_PREFIX)).map(Self)
    }

    /// Returns the path of the folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.0.work()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scratch_folder_is_removed_with_its_value() {
        let scratch = ScratchFolder::new().unwrap();
        let path = scratch.path().to_owned();
        std::fs::write(path.join("file"), "contents").unwrap();
        drop(scratch);
        assert!(!path.parent().unwrap().exists());
    }
}
