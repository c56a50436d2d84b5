// SPDX-License-Identifier: MIT OR Apache-2.0
//! One file, whole or as it was.

use std::io::Write;
use std::path::Path;

use crate::StagingError;

/// Writes `contents` beside `path` and renames it into place; a file that is there is replaced.
///
/// # Errors
/// When the folder does not exist or cannot be written.
pub fn write_file(path: &Path, contents: &[u8]) -> Result<(), StagingError> {
    let failed = StagingError::write(path);
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let mut beside = tempfile::Builder::new()
        .prefix(".foveate-")
        .tempfile_in(folder.unwrap_or(Path::new(".")))
        .map_err(&failed)?;
    beside.write_all(contents).map_err(&failed)?;
    readable_by_all(beside.as_file()).map_err(&failed)?;
    beside.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// A temporary file is private; what is left is as readable as what other programs write.
#[cfg(unix)]
fn readable_by_all(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_all(_file: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.xml");
        write_file(&path, b"old").unwrap();
        write_file(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        let nowhere = folder.path().join("no/report.xml");
        let message = write_file(&nowhere, b"").unwrap_err().to_string();
        assert!(message.contains("no/report.xml"), "{message}");
    }
}
