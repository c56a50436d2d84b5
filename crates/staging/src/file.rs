// SPDX-License-Identifier: MIT OR Apache-2.0
//! One file, whole or as it was.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek as _, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::StagingError;
use crate::leftover::{TEMPORARY, sweep_once};
use crate::lock::{LETTERS, is_same_file, plain};

/// Links that are followed from one to the next.
const LINKS: usize = 40;

/// Writes `contents` beside `path` and renames it into place; a file that is there is replaced, and keeps its mode, owner and
/// links. A link keeps pointing where it points; what is no file, such as `/dev/stdout`, is written to.
///
/// # Errors
/// When the folder does not exist or cannot be written.
pub fn write_file(path: &Path, contents: &[u8]) -> Result<(), StagingError> {
    let place = followed(path);
    let written = match fs::metadata(&place) {
        Ok(earlier) if earlier.is_file() => replace(&place, contents, &earlier),
        Ok(_) => fs::write(&place, contents),
        Err(_) => create(&place, contents),
    };
    written.map_err(StagingError::write(path))
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

/// Where a path leads, also to a file that is not there yet.
fn followed(path: &Path) -> PathBuf {
    let mut place = path.to_owned();
    for _ in 0..LINKS {
        if let Ok(whole) = place.canonicalize() {
            return whole;
        }
        let Ok(next) = fs::read_link(&place) else { break };
        place = folder_of(&place).join(next);
    }
    place
}

/// A new file is as readable as what other programs write.
fn create(place: &Path, contents: &[u8]) -> io::Result<()> {
    const MODE: u32 = 0o666;
    filled(place, contents, MODE)?.persist(place).map(drop).map_err(|error| plain(&error.error))
}

/// A file that is there keeps what it is to others. Where that takes its own place on the disk, it is written over.
fn replace(place: &Path, contents: &[u8], earlier: &fs::Metadata) -> io::Result<()> {
    const MODE: u32 = 0o600;
    let whole = filled(place, contents, MODE).and_then(|beside| {
        let keeps = keep_owner_and_mode(beside.as_file(), earlier)?;
        Ok(keeps.then_some(beside))
    });
    match whole {
        Ok(Some(beside)) => match beside.persist(place) {
            Ok(_) => Ok(()),
            Err(error) if is_refused(&error.error) => write_over(place, contents),
            Err(error) => Err(plain(&error.error)),
        },
        Ok(None) => write_over(place, contents),
        Err(error) if is_refused(&error) => write_over(place, contents),
        Err(error) => Err(error),
    }
}

/// Whether a folder cannot be written, which says nothing of the files in it.
fn is_refused(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem)
}

/// A complete file beside its place, which this process has locked: nobody takes it for one that was left.
fn filled(place: &Path, contents: &[u8], mode: u32) -> io::Result<NamedTempFile> {
    let folder = folder_of(place);
    sweep_once(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY).rand_bytes(LETTERS);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    #[cfg(not(unix))]
    let _ = mode;
    loop {
        let mut beside = builder.tempfile_in(folder).map_err(|error| plain(&error))?;
        // Where files cannot be locked nobody removes it either.
        let _ = beside.as_file().lock();
        if is_same_file(beside.as_file(), beside.path()) {
            beside.as_file_mut().write_all(contents)?;
            return Ok(beside);
        }
    }
}

/// Writes over a file in its place. If there is no room, what was there is there again.
fn write_over(place: &Path, contents: &[u8]) -> io::Result<()> {
    let earlier = fs::read(place)?;
    let mut file = OpenOptions::new().write(true).open(place)?;
    let mut put = |bytes: &[u8]| {
        file.rewind()?;
        file.write_all(bytes)?;
        file.set_len(bytes.len() as u64)
    };
    put(contents).inspect_err(|_| {
        // It takes no more room than it did.
        let _ = put(&earlier);
    })
}

/// Gives a file the owner and the mode of another. Whether a file in its place is the same to others: it is not if that has
/// further names, or if its owner cannot be kept.
#[cfg(unix)]
fn keep_owner_and_mode(file: &File, earlier: &fs::Metadata) -> io::Result<bool> {
    use std::os::unix::fs::{MetadataExt as _, fchown};
    let own = file.metadata()?;
    let is_other = |own: u32, earlier: u32| (own != earlier).then_some(earlier);
    let (user, group) = (is_other(own.uid(), earlier.uid()), is_other(own.gid(), earlier.gid()));
    let is_kept = (user.is_none() && group.is_none()) || fchown(file, user, group).is_ok();
    // After the owner, whose change takes some bits of the mode away.
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
                message.contains("no/report.xml`") && !message.contains(TEMPORARY),
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
