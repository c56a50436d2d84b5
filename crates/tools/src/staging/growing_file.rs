// SPDX-License-Identifier: MIT OR Apache-2.0
//! A file that grows, and loses no data when the disk is full: bytes are collected in memory, and
//! those that do not fit stay there until there is room.

use std::fs::{File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::staging::StagingError;

/// The number of bytes from which a system call is worthwhile.
const WRITE_THRESHOLD: usize = 1 << 16;

/// An open file and the bytes that are not written yet.
#[derive(Debug)]
pub struct GrowingFile {
    path: PathBuf,
    file: File,
    pending: Vec<u8>,
}

impl GrowingFile {
    /// Creates a file, or truncates an existing one.
    ///
    /// # Errors
    /// Fails if the file cannot be written.
    pub fn create(path: &Path) -> Result<Self, StagingError> {
        Self::open(path, OpenOptions::new().write(true).create(true).truncate(true))
    }

    /// Creates a file that must not exist yet.
    ///
    /// # Errors
    /// Fails if the file exists or cannot be written.
    pub fn create_new(path: &Path) -> Result<Self, StagingError> {
        Self::open(path, OpenOptions::new().write(true).create_new(true))
    }

    fn open(path: &Path, options: &OpenOptions) -> Result<Self, StagingError> {
        let file = options.open(path).map_err(StagingError::unwritable(path))?;
        Ok(Self { path: path.to_owned(), file, pending: Vec::new() })
    }

    /// Appends bytes to the file.
    pub fn append(&mut self, bytes: &[u8]) {
        self.pending.extend_from_slice(bytes);
    }

    /// Returns the pending bytes, to which more can be appended.
    pub fn pending_mut(&mut self) -> &mut Vec<u8> {
        &mut self.pending
    }

    /// Writes the pending bytes if there are many of them.
    ///
    /// # Errors
    /// Fails like [`GrowingFile::write_all`].
    pub fn write_pending(&mut self) -> Result<(), StagingError> {
        if self.pending.len() < WRITE_THRESHOLD { Ok(()) } else { self.write_all() }
    }

    /// Writes all pending bytes.
    ///
    /// # Errors
    /// Fails if the disk is full or the file cannot be written. Bytes that were not written are
    /// kept.
    pub fn write_all(&mut self) -> Result<(), StagingError> {
        let unwritable = StagingError::unwritable(&self.path);
        while !self.pending.is_empty() {
            match self.file.write(&self.pending) {
                Ok(0) => return Err(unwritable(io::ErrorKind::WriteZero.into())),
                Ok(written) => drop(self.pending.drain(..written)),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(unwritable(error)),
            }
        }
        Ok(())
    }

    /// Writes all pending bytes, and then overwrites bytes at the offset `at`.
    ///
    /// # Errors
    /// Fails like [`GrowingFile::write_all`].
    pub fn overwrite(&mut self, at: u64, bytes: &[u8]) -> Result<(), StagingError> {
        self.write_all()?;
        self.file
            .seek(SeekFrom::Start(at))
            .and_then(|_| self.file.write_all(bytes))
            .and_then(|()| self.file.seek(SeekFrom::End(0)))
            .map(drop)
            .map_err(StagingError::unwritable(&self.path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_written_in_large_pieces_or_on_request_and_can_be_overwritten() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("file");
        let mut file = GrowingFile::create(&path).unwrap();
        file.append(b"head");
        file.write_pending().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"");
        file.append(&[7; WRITE_THRESHOLD]);
        file.write_pending().unwrap();
        file.overwrite(0, b"HE").unwrap();
        file.append(b"end");
        file.write_all().unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!((&bytes[..5], bytes.len()), (&b"HEad\x07"[..], WRITE_THRESHOLD + 7));
        assert!(GrowingFile::create_new(&path).is_err(), "nothing is written over");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn bytes_that_do_not_fit_on_the_disk_are_kept() {
        let mut file = GrowingFile::create(Path::new("/dev/full")).unwrap();
        file.append(b"kept");
        let error = file.write_all().unwrap_err();
        assert!(error.is_full() && error.to_string().contains("/dev/full"), "{error}");
        assert_eq!(file.pending_mut(), b"kept");
    }
}
