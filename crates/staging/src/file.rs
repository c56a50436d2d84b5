// SPDX-License-Identifier: MIT OR Apache-2.0
//! One file, whole or as it was.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use crate::StagingError;

/// How the names of files begin that [`write_file`] has not finished. A process that is killed leaves them.
pub const TEMPORARY: &str = ".foveate-";

/// Writes `contents` beside `path` and renames it into place; a file that is there is replaced. A
/// link keeps pointing where it points; what is no file, such as `/dev/stdout`, is written to.
///
/// # Errors
/// When the folder does not exist or cannot be written.
pub fn write_file(path: &Path, contents: &[u8]) -> Result<(), StagingError> {
    let failed = StagingError::write(path);
    let place = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if place.exists() && !place.is_file() {
        return fs::write(&place, contents).map_err(failed);
    }
    replace(&place, contents).map_err(failed)
}

/// Whether [`write_file`] can write there, as far as can be told before: to refuse it before hours of
/// work.
///
/// # Errors
/// When the folder does not exist or is none, or `path` is a folder.
pub fn check_file(path: &Path) -> Result<(), StagingError> {
    let refused = |kind: io::ErrorKind| Err(StagingError::write(path)(kind.into()));
    if path.is_dir() {
        return refused(io::ErrorKind::IsADirectory);
    }
    if folder_of(path).is_dir() { Ok(()) } else { refused(io::ErrorKind::NotFound) }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn replace(place: &Path, contents: &[u8]) -> io::Result<()> {
    // The error of a temporary file names that file, which nobody has asked for.
    let plain = |error: io::Error| io::Error::from(error.kind());
    let mut beside =
        tempfile::Builder::new().prefix(TEMPORARY).tempfile_in(folder_of(place)).map_err(plain)?;
    beside.write_all(contents).map_err(plain)?;
    readable_by_all(beside.as_file()).map_err(plain)?;
    beside.persist(place).map(drop).map_err(|error| plain(error.error))
}

/// A temporary file is private; what is left is as readable as what other programs write.
#[cfg(unix)]
fn readable_by_all(file: &fs::File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_all(_file: &fs::File) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.xml");
        check_file(&path).unwrap();
        write_file(&path, b"old").unwrap();
        write_file(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn places_that_cannot_be_written_are_named_as_given() {
        let folder = tempfile::tempdir().unwrap();
        let nowhere = folder.path().join("no/report.xml");
        for result in [write_file(&nowhere, b""), check_file(&nowhere)] {
            let message = result.unwrap_err().to_string();
            assert!(
                message.contains("no/report.xml`") && !message.contains(".foveate-"),
                "{message}"
            );
        }
        assert!(check_file(folder.path()).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "old").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        write_file(&link, b"new").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"new");
        assert!(link.is_symlink());
        write_file(Path::new("/dev/null"), b"gone").unwrap();
        assert!(!Path::new("/dev/null").is_file());
    }
}
