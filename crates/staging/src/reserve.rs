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
    /// Takes up `bytes` in `folder`, under a name of its own, or half of the room where there are not as many.
    #[must_use]
    pub fn new(folder: &Path, name: &str, bytes: u64) -> Self {
        let reserve = Self { path: folder.join(name) };
        // Room that cannot be taken is no loss: the end is then tried without it.
        let _ = fill(&reserve.path, bytes);
        reserve
    }
}

/// Whether there are so many bytes of room in a folder.
#[must_use]
pub fn has_room(folder: &Path, bytes: u64) -> bool {
    let probe = Reserve { path: folder.join(".probe") };
    File::create_new(&probe.path).and_then(|mut file| zeros(&mut file, bytes).1).is_ok()
}

impl Drop for Reserve {
    fn drop(&mut self) {
        // It goes with its folder otherwise.
        let _ = fs::remove_file(&self.path);
    }
}

/// A file that is not written to takes up no room.
fn fill(path: &Path, bytes: u64) -> io::Result<()> {
    let mut file = File::create_new(path)?;
    match zeros(&mut file, bytes) {
        (_, Ok(())) => Ok(()),
        (written, Err(_)) => file.set_len(written / 2),
    }
}

/// Writes so many zeros or a few more, and tells how far it came.
fn zeros(file: &mut File, bytes: u64) -> (u64, io::Result<()>) {
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
    fn room_is_taken_and_given_back() {
        let dir = tempfile::tempdir().unwrap();
        assert!(has_room(dir.path(), 100_000));
        let reserve = Reserve::new(dir.path(), ".reserve", 100_000);
        assert!(fs::metadata(&reserve.path).unwrap().len() >= 100_000);
        drop(reserve);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
