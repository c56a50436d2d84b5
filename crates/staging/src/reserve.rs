// SPDX-License-Identifier: MIT OR Apache-2.0
//! Room that is kept free for the end: on a full disk what was written can still be completed.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that takes up room, and gives it back when it is dropped.
#[derive(Debug)]
pub struct Reserve {
    path: PathBuf,
}

impl Reserve {
    /// Takes up `bytes` in `folder`, if there are as many.
    #[must_use]
    pub fn new(folder: &Path, bytes: u64) -> Option<Self> {
        let reserve = Self { path: folder.join(".reserve") };
        // A file that is not written to takes up no room.
        fill(&reserve.path, bytes).ok().map(|()| reserve)
    }
}

impl Drop for Reserve {
    fn drop(&mut self) {
        // It goes with its folder otherwise.
        let _ = fs::remove_file(&self.path);
    }
}

fn fill(path: &Path, bytes: u64) -> io::Result<()> {
    static BLOCK: [u8; 1 << 16] = [0; 1 << 16];
    let mut file = File::create_new(path)?;
    for _ in 0..bytes.div_ceil(BLOCK.len() as u64) {
        file.write_all(&BLOCK)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_is_taken_and_given_back() {
        let dir = tempfile::tempdir().unwrap();
        let reserve = Reserve::new(dir.path(), 100_000).unwrap();
        assert!(fs::metadata(&reserve.path).unwrap().len() >= 100_000);
        drop(reserve);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
