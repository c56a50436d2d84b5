// SPDX-License-Identifier: MIT OR Apache-2.0
//! Disk space that is reserved for the end of a run, so that an output can be completed on a full
//! disk.

use std::fs::File;
use std::io::Write as _;
use std::path::Path;

/// A file without a name that occupies disk space, and frees it when it is dropped. It is `None` if
/// there is no such file; the run then ends without reserved space.
#[derive(Debug)]
pub struct SpaceReserve(Option<File>);

impl SpaceReserve {
    /// Occupies `bytes` of the disk of `folder`, or half of the free space if there is less.
    #[must_use]
    pub fn new(folder: &Path, bytes: u64) -> Self {
        let reserve = Self(tempfile::tempfile_in(folder).ok());
        let written = reserve.fill(bytes);
        if let Some(file) = &reserve.0
            && written < bytes
        {
            // If this fails, the space is freed when the reserve is dropped.
            let _ = file.set_len(written / 2);
        }
        reserve
    }

    /// Writes at least this number of zeros, because a file without data occupies no space. Returns
    /// the number of bytes that found space.
    fn fill(&self, bytes: u64) -> u64 {
        static BLOCK: [u8; 1 << 14] = [0; 1 << 14];
        let mut written = 0;
        while written < bytes
            && self.0.as_ref().is_some_and(|mut file| file.write_all(&BLOCK).is_ok())
        {
            written += BLOCK.len() as u64;
        }
        written
    }
}

/// Returns whether a folder has room for this number of bytes.
#[must_use]
pub fn has_room(folder: &Path, bytes: u64) -> bool {
    SpaceReserve(tempfile::tempfile_in(folder).ok()).fill(bytes) >= bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reserve_occupies_space_and_has_no_name() {
        let dir = tempfile::tempdir().unwrap();
        assert!(has_room(dir.path(), 100_000));
        assert!(!has_room(&dir.path().join("missing"), 1));
        let reserve = SpaceReserve::new(dir.path(), 100_000);
        assert!(reserve.0.as_ref().unwrap().metadata().unwrap().len() >= 100_000);
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
