// SPDX-License-Identifier: MIT OR Apache-2.0
//! Disk space that is reserved for the end of a run, so that an output can be completed on a full
//! disk.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that occupies disk space, and frees it when it is dropped.
#[derive(Debug)]
pub struct SpaceReserve {
    path: PathBuf,
}

impl SpaceReserve {
    /// Occupies `bytes` in `folder` with a file of this name, or half of the free space if there is
    /// less.
    #[must_use]
    pub fn new(folder: &Path, name: &str, bytes: u64) -> Self {
        let reserve = Self { path: folder.join(name) };
        // A failure is ignored; the run then ends without reserved space.
        let _ = fill_with_zeros(&reserve.path, bytes);
        reserve
    }
}

/// Returns whether a folder has room for this number of bytes.
#[must_use]
pub fn has_room(folder: &Path, bytes: u64) -> bool {
    // The file has no name on Unix, so that a killed process leaves nothing in the folder.
    tempfile::tempfile_in(folder).and_then(|mut file| write_zeros(&mut file, bytes).1).is_ok()
}

impl Drop for SpaceReserve {
    fn drop(&mut self) {
        // If this fails, the file is removed with its folder.
        let _ = fs::remove_file(&self.path);
    }
}

/// Fills a new file with zeros, because a file without data occupies no space.
fn fill_with_zeros(path: &Path, bytes: u64) -> io::Result<()> {
    let mut file = File::create_new(path)?;
    match write_zeros(&mut file, bytes) {
        (_, Ok(())) => Ok(()),
        (written, Err(_)) => file.set_len(written / 2),
    }
}

/// Writes at least this number of zeros. Returns the number of bytes that were written.
fn write_zeros(file: &mut File, bytes: u64) -> (u64, io::Result<()>) {
    static BLOCK: [u8; 1 << 14] = [0; 1 << 14];
    let mut written = 0;
    while written < bytes {
        if let Err(error) = file.write_all(&BLOCK) {
            return (written, Err(error));
        }
        written += BLOCK.len() as u64;
    }
    (written, Ok(()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reserve_occupies_space_until_it_is_dropped() {
        let dir = tempfile::tempdir().unwrap();
        assert!(has_room(dir.path(), 100_000));
        assert!(!has_room(&dir.path().join("missing"), 1));
        let reserve = SpaceReserve::new(dir.path(), ".reserve", 100_000);
        assert!(fs::metadata(&reserve.path).unwrap().len() >= 100_000);
        drop(reserve);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
