// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes one file completely, or leaves it unchanged.

use std::fs::{self, OpenOptions};
use std::io::{self, Seek as _, Write as _};
use std::path::Path;

use crate::staging::StagingError;
use crate::staging::scratch_folder::create_locked_file;

/// Writes `contents` into a temporary file next to `path` and renames it into place. An existing
/// file is replaced and keeps its mode, owner and hard links. A symbolic link keeps its target.
/// Special files such as `/dev/stdout`, and links to files that do not exist, are written directly.
///
/// # Errors
/// Fails if the folder does not exist or cannot be written.
pub fn write_file(path: &Path, contents: &[u8]) -> Result<(), StagingError> {
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let written = match fs::metadata(&target) {
        Ok(previous) if previous.is_file() => match replace(&target, contents, Some(&previous)) {
            Err(error) if is_refused(&error) => overwrite(&target, contents),
            written => written,
        },
        Err(_) if !target.is_symlink() => replace(&target, contents, None),
        _ => fs::write(&target, contents),
    };
    written.map_err(StagingError::unwritable(path))
}

/// Checks whether [`write_file`] can write to a path, as far as this is known in advance, so that a
/// run can fail before hours of work.
///
/// # Errors
/// Fails if the folder does not exist or is not a folder, or if `path` is a folder.
pub fn check_file(path: &Path) -> Result<(), StagingError> {
    let refused = |kind: io::ErrorKind| Err(StagingError::unwritable(path)(kind.into()));
    if path.is_dir() {
        return refused(io::ErrorKind::IsADirectory);
    }
    if folder_of(path).is_dir() { Ok(()) } else { refused(io::ErrorKind::NotFound) }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Writes a new file. If it cannot replace the previous one without a difference to other users,
/// that is overwritten.
fn replace(target: &Path, contents: &[u8], previous: Option<&fs::Metadata>) -> io::Result<()> {
    // No other user can open the file before it has the mode of the previous one.
    let mode = if previous.is_some() { 0o600 } else { 0o666 };
    let mut file = create_locked_file(folder_of(target), mode)?;
    if let Some(previous) = previous {
        if !can_replace(&file.as_file().metadata()?, previous) {
            return overwrite(target, contents);
        }
        file.as_file().set_permissions(previous.permissions())?;
    }
    file.as_file_mut().write_all(contents)?;
    file.persist(target).map(drop).map_err(|refused| refused.error)
}

/// Returns whether a new file can replace another: it cannot if the other has further hard links,
/// or another owner.
#[cfg(unix)]
fn can_replace(new: &fs::Metadata, previous: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let owner = |about: &fs::Metadata| (about.uid(), about.gid());
    owner(new) == owner(previous) && previous.nlink() == 1
}

#[cfg(not(unix))]
fn can_replace(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    true
}

/// Returns whether an error says that a folder cannot be written. Its files may be writable all the
/// same.
fn is_refused(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem)
}

/// Overwrites a file in place. If the disk is full, the previous contents are restored.
fn overwrite(target: &Path, contents: &[u8]) -> io::Result<()> {
    let previous = fs::read(target)?;
    let mut file = OpenOptions::new().write(true).open(target)?;
    let mut write_whole = |bytes: &[u8]| {
        file.rewind()?;
        file.write_all(bytes)?;
        file.set_len(bytes.len() as u64)
    };
    write_whole(contents).inspect_err(|_| {
        // The previous contents need no more room than before.
        let _ = write_whole(&previous);
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::staging::TEMPORARY_PREFIX;

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
    fn an_error_names_the_path_as_the_user_gave_it() {
        let folder = tempfile::tempdir().unwrap();
        let nowhere = folder.path().join("no/report.xml");
        for result in [write_file(&nowhere, b""), check_file(&nowhere)] {
            let message = result.unwrap_err().to_string();
            assert!(
                message.contains("no/report.xml`") && !message.contains(TEMPORARY_PREFIX),
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
        fs::remove_file(&target).unwrap();
        write_file(&link, b"made").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"made");
        assert!(link.is_symlink());
        write_file(Path::new("/dev/null"), b"gone").unwrap();
        assert!(!Path::new("/dev/null").is_file());
    }

    #[cfg(unix)]
    #[test]
    fn a_file_keeps_its_mode_its_owner_and_its_other_names() {
        use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, chown};
        let folder = tempfile::tempdir().unwrap();
        let [path, plain, other] = ["file", "plain", "other"].map(|name| folder.path().join(name));
        let mode = |path: &Path| fs::metadata(path).unwrap().mode() & 0o7777;
        fs::write(&plain, "").unwrap();
        write_file(&path, b"old").unwrap();
        assert_eq!(mode(&path), mode(&plain), "a new file follows the umask");
        for bits in [0o600, 0o640, 0o755, 0o444] {
            fs::set_permissions(&path, fs::Permissions::from_mode(bits)).unwrap();
            write_file(&path, b"new").unwrap();
            assert_eq!(mode(&path), bits);
        }
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
        fs::hard_link(&path, &other).unwrap();
        write_file(&path, b"shorter").unwrap();
        write_file(&path, b"s").unwrap();
        assert_eq!(fs::read(&other).unwrap(), b"s");
        if chown(&path, Some(1234), Some(1235)).is_ok() {
            write_file(&path, b"linked").unwrap();
            fs::remove_file(&other).unwrap();
            write_file(&path, b"alone").unwrap();
            let about = fs::metadata(&path).unwrap();
            assert_eq!((about.uid(), about.gid(), mode(&path)), (1234, 1235, 0o600));
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
