// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder for intermediate results among the temporary files.

use std::ffi::OsStr;
use std::io;
use std::path::Path;

use crate::leftover::{SCRATCH, sweep_once};
use crate::lock::LockedFolder;

/// The folder, which goes with this value; that of a process that was killed goes when the next one is made.
#[derive(Debug)]
pub struct ScratchFolder(LockedFolder);

impl ScratchFolder {
    /// Makes it in the folder of temporary files.
    ///
    /// # Errors
    /// When that cannot be written.
    pub fn new() -> io::Result<Self> {
        let parent = std::env::temp_dir();
        sweep_once(&parent);
        LockedFolder::create(&parent, OsStr::new(SCRATCH)).map(Self)
    }

    /// Where to work.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.0.work()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_goes_with_its_value() {
        let scratch = ScratchFolder::new().unwrap();
        let path = scratch.path().to_owned();
        std::fs::write(path.join("file"), "contents").unwrap();
        drop(scratch);
        assert!(!path.parent().unwrap().exists());
    }
}
