// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes one file completely, or leaves it unchanged.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek as _, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::StagingError;
use crate::leftovers::{TEMPORARY_PREFIX, remove_leftovers_once};
use crate::locked_folder::{RANDOM_LETTERS, is_same_file, without_path};

/// The largest number of links that are followed.
const MAX_LINKS: usize = 40;

/// Writes `contents` into a temporary file next to `path` and renames it into place. An existing
/// file is replaced and keeps its mode, owner and hard links. A symbolic link keeps its target.
/// Special files such as `/dev/stdout` are written directly.
///
/// # Errors
/// Fails if the folder does not exist or cannot be written.
pub fn write_file(path: &Path, contents: &[u8]) -> Result<(), StagingError> {
    let place = resolve_links(path);
    let written = match fs::metadata(&place) {
        Ok(earlier) if earlier.is_file() => replace(&place, contents, &earlier),
        Ok(_) => fs::write(&place, contents),
        Err(_) => create(&place, contents),
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
    let mut place = path.to_owned();
    for _ in 0..MAX_LINKS {
        if let Ok(whole) = place.canonicalize() {
            return whole;
        }
        let Ok(next) = fs::read_link(&place) else { break };
        place = folder_of(&place).join(next);
    }
    place
}

/// Writes a new file, with the same permissions as files of other programs.
fn create(place: &Path, contents: &[u8]) -> io::Result<()> {
    const MODE: u32 = 0o666;
    write_temporary_file(place, contents, MODE)?
        .persist(place)
        .map(drop)
        .map_err(|error| without_path(&error.error))
}

/// Replaces an existing file and keeps its owner, mode and links. If that requires the same inode,
/// the file is overwritten in place.
fn replace(place: &Path, contents: &[u8], earlier: &fs::Metadata) -> io::Result<()> {
    const MODE: u32 = 0o600;
    let whole = write_temporary_file(place, contents, MODE).and_then(|beside| {
        let keeps = keep_owner_and_mode(beside.as_file(), earlier)?;
        Ok(keeps.then_some(beside))
    });
    match whole {
        Ok(Some(beside)) => match beside.persist(place) {
            Ok(_) => Ok(()),
            Err(error) if is_refused(&error.error) => overwrite(place, contents),
            Err(error) => Err(without_path(&error.error)),
        },
        Ok(None) => overwrite(place, contents),
        Err(error) if is_refused(&error) => overwrite(place, contents),
        Err(error) => Err(error),
    }
}

/// Returns whether a folder cannot be written, which does not imply that its files cannot.
fn is_refused(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem)
}

/// Makes a complete file next to its place. This process locks the file, so that no other process
/// removes it as a leftover.
fn write_temporary_file(place: &Path, contents: &[u8], mode: u32) -> io::Result<NamedTempFile> {
    let folder = folder_of(place);
    remove_leftovers_once(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY_PREFIX).rand_bytes(RANDOM_LETTERS);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    #[cfg(not(unix))]
    let _ = mode;
    loop {
        let mut beside = builder.tempfile_in(folder).map_err(|error| without_path(&error))?;
        // If files cannot be locked, no other process removes this file either.
        let _ = beside.as_file().lock();
        if is_same_file(beside.as_file(), beside.path()) {
            beside.as_file_mut().write_all(contents)?;
            return Ok(beside);
        }
    }
}

/// Overwrites a file in place. If the disk is full, the previous contents are restored.
fn overwrite(place: &Path, contents: &[u8]) -> io::Result<()> {
    let earlier = fs::read(place)?;
    let mut file = OpenOptions::new().write(true).open(place)?;
    let mut put = |bytes: &[u8]| {
        file.rewind()?;
        file.write_all(bytes)?;
        file.set_len(bytes.len() as u64)
    };
    put(contents).inspect_err(|_| {
        // The previous contents need no more room than before.
        let _ = put(&earlier);
    })
}

/// Gives a file the owner and the mode of another. Returns whether the file can replace the other
/// without a difference to other users: it cannot if the other has further hard links, or if its
/// owner cannot be kept.
#[cfg(unix)]
fn keep_owner_and_mode(file: &File, earlier: &fs::Metadata) -> io::Result<bool> {
    use std::os::unix::fs::{MetadataExt as _, fchown};
    let own = file.metadata()?;
    let is_other = |own: u32, earlier: u32| (own != earlier).then_some(earlier);
    let (user, group) = (is_other(own.uid(), earlier.uid()), is_other(own.gid(), earlier.gid()));
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
    fn places_that_cannot_be_written_are_named_as_given() {
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
