// SPDX-License-Identifier: MIT OR Apache-2.0
//! How inputs are read: files are opened in one place ([`open_file`]), small ones are read as a
//! whole ([`read_bytes`]), gzipped ones are unpacked ([`unpacked`]), and a reader can fail at a
//! limit ([`LimitedReader`]).

use crate::reading::size_text::size_text;
use flate2::bufread::MultiGzDecoder;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek};
use std::path::Path;

/// The largest size of a settings file in bytes; a typical one has a few KiB.
pub const SETTINGS_LIMIT: u64 = 1 << 20;

/// The beginning of a text that Git LFS stores in place of a large file.
const LFS_POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";

/// Opens an input file.
///
/// # Errors
/// Fails if the file cannot be opened, or if it is a pointer of Git LFS in place of a file.
pub fn open_file(path: &Path) -> io::Result<File> {
    let mut file = File::open(path)?;
    let known = file.metadata()?;
    // Git LFS calls longer texts no pointers.
    if known.is_file() && known.len() < 1024 {
        let mut start = Vec::new();
        (&mut file).take(LFS_POINTER.len() as u64).read_to_end(&mut start)?;
        if start == LFS_POINTER {
            return Err(io::Error::other(
                "it is a pointer of Git LFS, not the file itself; fetch the file with `git lfs pull`",
            ));
        }
        file.rewind()?;
    }
    Ok(file)
}

/// Reads a file of at most `limit` bytes. The file may be a pipe or a device, whose length is not
/// known in advance.
///
/// # Errors
/// Fails if the file cannot be read or has more bytes ([`io::ErrorKind::FileTooLarge`]).
pub fn read_bytes(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    LimitedReader::new(open_file(path)?, limit).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a settings file of at most [`SETTINGS_LIMIT`] bytes: a configuration, space, board, sensor
/// or accelerator.
///
/// # Errors
/// Fails like [`read_text`].
pub fn read_settings(path: &Path) -> io::Result<String> {
    read_text(path, SETTINGS_LIMIT)
}

/// Reads the text of a settings file from a source that is open already, such as standard input.
///
/// # Errors
/// Fails like [`read_text`].
pub fn settings_from(source: impl Read) -> io::Result<String> {
    let mut bytes = Vec::new();
    LimitedReader::new(source, SETTINGS_LIMIT).read_to_end(&mut bytes)?;
    text_of(bytes)
}

/// Reads a UTF-8 text of at most `limit` bytes.
///
/// # Errors
/// Fails like [`read_bytes`], and if the file is not text ([`io::ErrorKind::InvalidData`]).
pub fn read_text(path: &Path, limit: u64) -> io::Result<String> {
    text_of(read_bytes(path, limit)?)
}

fn text_of(bytes: Vec<u8>) -> io::Result<String> {
    String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        let message = format!("it is not text in UTF-8, from byte {place} on");
        io::Error::new(io::ErrorKind::InvalidData, message)
    })
}

/// A reader that fails with [`io::ErrorKind::FileTooLarge`] if its source has more bytes than the
/// limit. [`Read::take`] would instead end the document at the limit, as if it were complete.
#[derive(Debug)]
pub struct LimitedReader<R> {
    source: R,
    limit: u64,
    remaining: u64,
}

impl<R: Read> LimitedReader<R> {
    /// Makes a reader of at most `limit` bytes.
    pub fn new(source: R, limit: u64) -> Self {
        Self { source, limit, remaining: limit }
    }
}

impl<R: Read> Read for LimitedReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if buffer.is_empty() {
            return Ok(0);
        }
        if self.remaining == 0 {
            // The source may end exactly at the limit.
            return match self.source.read(&mut [0])? {
                0 => Ok(0),
                _ => Err(self.too_large()),
            };
        }
        let allowed = buffer.len().min(usize::try_from(self.remaining).unwrap_or(usize::MAX));
        let count = self.source.read(&mut buffer[..allowed])?;
        self.remaining -= count as u64;
        Ok(count)
    }
}

impl<R> LimitedReader<R> {
    fn too_large(&self) -> io::Error {
        let message = format!("it is larger than {}, which is the limit", size_text(self.limit));
        io::Error::new(io::ErrorKind::FileTooLarge, message)
    }
}

/// The first bytes of a gzipped file.
pub const GZIP_MAGIC: [u8; 2] = [0x1F, 0x8B];

/// Returns the content of a file, unpacked if it is gzipped. The content may be much larger than
/// the file, so the caller limits it.
///
/// # Errors
/// Fails if the first bytes cannot be read.
pub fn unpacked(input: impl Read + Send + 'static) -> io::Result<Box<dyn BufRead + Send>> {
    let mut input = BufReader::new(input);
    if input.fill_buf()?.starts_with(&GZIP_MAGIC) {
        return Ok(Box::new(BufReader::new(MultiGzDecoder::new(input))));
    }
    Ok(Box::new(input))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_may_be_as_large_as_the_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, "12345678").unwrap();
        assert_eq!(read_text(&path, 8).unwrap(), "12345678");
        let error = read_bytes(&path, 7).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::FileTooLarge);
        assert_eq!(error.to_string(), "it is larger than 7 bytes, which is the limit");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_without_an_end_is_refused() {
        let error = read_settings(Path::new("/dev/zero")).unwrap_err();
        assert_eq!(error.to_string(), "it is larger than 1 MiB, which is the limit");
    }

    #[test]
    fn a_pointer_of_git_lfs_is_not_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, [LFS_POINTER, b"v1\noid sha256:aa\nsize 12345\n"].concat()).unwrap();
        assert!(open_file(&path).unwrap_err().to_string().contains("`git lfs pull`"));
        std::fs::write(&path, &LFS_POINTER[..20]).unwrap();
        assert_eq!(read_bytes(&path, 100).unwrap(), &LFS_POINTER[..20]);
    }

    #[test]
    fn an_error_names_the_first_byte_that_is_not_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, b"abc\xFF").unwrap();
        let error = read_text(&path, 8).unwrap_err();
        assert_eq!(error.to_string(), "it is not text in UTF-8, from byte 3 on");
        assert_eq!(read_bytes(&path, 8).unwrap(), b"abc\xFF");
    }

    fn read(length: usize, limit: u64) -> io::Result<usize> {
        let source = vec![1; length];
        LimitedReader::new(source.as_slice(), limit).read_to_end(&mut Vec::new())
    }

    #[test]
    fn a_source_beyond_the_limit_is_an_error_and_does_not_end_early() {
        assert_eq!(read(4, 5).unwrap(), 4);
        assert_eq!(read(5, 5).unwrap(), 5);
        assert_eq!(read(6, 5).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
    }
}
