// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes one file completely, or leaves it unchanged.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek as _, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::staging::StagingError;
use crate::staging::leftovers::{TEMPORARY_PREFIX, remove_leftovers_once};
use crate::staging::locked_folder::{RANDOM_LETTERS, is_same_file, without_path};

/// The largest number of links that are followed.
const MAX_LINKS: usize = 40;

/// Writes `contents` into a temporary file next to `path` and renames it into place. An existing
/// file is replaced and keeps its mode, owner and hard links. A symbolic link keeps its target.
/// Special files such as `/dev/stdout` are written directly.
///
/// # Errors
/// Fails if the folder does not exist or cannot be written.
pub fn write_file(path: &Path, contents: &[u8]) -> Result<(), StagingError> {
    let target = resolve_links(path);
    let written = match fs::metadata(&target) {
        Ok(previous) if previous.is_file() => replace(&target, contents, &previous),
        Ok(_) => fs::write(&target, contents),
        Err(_) => create(&target, contents),
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

/// Returns the target of a path after following links, even if the target does not exist yet.
fn resolve_links(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    for _ in 0..MAX_LINKS {
        if let Ok(resolved) = target.canonicalize() {
            return resolved;
        }
        let Ok(next) = fs::read_link(&target) else { break };
        target = folder_of(&target).join(next);
    }
    target
}

/// Writes a new file, with the same permissions as files of other programs.
fn create(target: &Path, contents: &[u8]) -> io::Result<()> {
    const MODE: u32 = 0o666;
    write_temporary_file(target, contents, MODE)?
        .persist(target)
        .map(drop)
        .map_err(|error| without_path(&error.error))
}

/// Replaces an existing file and keeps its owner, mode and links. If that requires the same inode,
/// the file is overwritten in place.
fn replace(target: &Path, contents: &[u8], previous: &fs::Metadata) -> io::Result<()> {
    const MODE: u32 = 0o600;
    let written = write_temporary_file(target, contents, MODE).and_then(|temporary| {
        let is_kept = keep_owner_and_mode(temporary.as_file(), previous)?;
        Ok(is_kept.then_some(temporary))
    });
    match written {
        Ok(Some(temporary)) => match temporary.persist(target) {
            Ok(_) => Ok(()),
            Err(error) if is_refused(&error.error) => overwrite(target, contents),
            Err(error) => Err(without_path(&error.error)),
        },
        Ok(None) => overwrite(target, contents),
        Err(error) if is_refused(&error) => overwrite(target, contents),
        Err(error) => Err(error),
    }
}

/// Returns whether an error says that a folder cannot be written. Its files may be writable all the
/// same.
fn is_refused(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem)
}

/// Writes a temporary file next to `target`. This process locks the file, so that no other process
/// removes it as a leftover.
fn write_temporary_file(target: &Path, contents: &[u8], mode: u32) -> io::Result<NamedTempFile> {
    let folder = folder_of(target);
    remove_leftovers_once(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY_PREFIX).rand_bytes(RANDOM_LETTERS);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    #[cfg(not(unix))]
    let _ = mode;
    // Another process may remove the file before it is locked. Then a new one is made.
    loop {
        let mut temporary = builder.tempfile_in(folder).map_err(|error| without_path(&error))?;
        // If files cannot be locked, no other process removes this file either.
        let _ = temporary.as_file().lock();
        if is_same_file(temporary.as_file(), temporary.path()) {
            temporary.as_file_mut().write_all(contents)?;
            return Ok(temporary);
        }
    }
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

/// Gives a file the owner and the mode of another. Returns whether the file can replace the other
/// without a difference to other users: it cannot if the other has further hard links, or if its
/// owner cannot be kept.
#[cfg(unix)]
fn keep_owner_and_mode(file: &File, earlier: &fs::Metadata) -> io::Result<bool> {
    use std::os::unix::fs::{MetadataExt as _, fchown};
    let present = file.metadata()?;
    let to_change = |present: u32, earlier: u32| (present != earlier).then_some(earlier);
    let (user, group) =
        (to_change(present.uid(), earlier.uid()), to_change(present.gid(), earlier.gid()));
    let is_kept = (user.is_none() && group.is_none()) || fchown(file, user, group).is_ok();
    // The mode is set after the owner, because a change of the owner clears some bits of the mode.
    file.set_permissions(earlier.permissions())?;
    Ok(is_kept && earlier.nlink() == 1)
}

#[cfg(not(unix))]
fn keep_owner_and_mode(_: &File, _: &fs::Metadata) -> io::Result<bool> {
    Ok(true)
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
