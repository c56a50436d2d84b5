// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads small files as a whole.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::LimitedReader;

/// The largest size of a settings file in bytes; a typical one has a few KiB.
pub const SETTINGS_LIMIT: u64 = 1 << 20;

/// Reads a file of at most `limit` bytes. The file may be a pipe or a device, whose length is not
/// known in advance.
///
/// # Errors
/// Fails if the file cannot be read or has more bytes ([`io::ErrorKind::FileTooLarge`]).
pub fn read_bytes(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    LimitedReader::new(File::open(path)?, limit).read_to_end(&mut bytes)?;
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
    fn an_error_names_the_first_byte_that_is_not_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, b"abc\xFF").unwrap();
        let error = read_text(&path, 8).unwrap_err();
        assert_eq!(error.to_string(), "it is not text in UTF-8, from byte 3 on");
        assert_eq!(read_bytes(&path, 8).unwrap(), b"abc\xFF");
    }
}
