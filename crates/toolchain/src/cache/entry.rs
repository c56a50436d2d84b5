// SPDX-License-Identifier: MIT OR Apache-2.0
//! The entries in use. A process that uses an entry holds a shared lock of its folder; a process
//! that removes it needs an exclusive lock. The system releases the locks of a process that ends,
//! in whatever way it ends.

use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::folder_trust;

/// A file of the cache, which is not removed as long as this value lives.
#[derive(Debug)]
pub struct CacheEntry {
    path: PathBuf,
    _hold: FolderLock,
}

/// A lock of a folder. It holds no lock on a system or file system that cannot lock folders; no
/// entries are removed there.
#[derive(Debug)]
pub(super) struct FolderLock(Option<File>);

impl CacheEntry {
    pub(super) fn new(path: PathBuf, hold: FolderLock) -> Self {
        Self { path, _hold: hold }
    }

    /// Returns the path of the file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the entry in the folder `place` if it is there, and marks it as used.
    pub(super) fn open_entry(place: &Path, artifact: &str) -> Option<Self> {
        let path = place.join(artifact);
        loop {
            let hold = FolderLock::shared(place)?;
            if !path.exists() || !folder_trust::is_entry(place, artifact) {
                return None;
            }
            if hold.locks_folder(place) {
                hold.touch();
                return Some(Self { path, _hold: hold });
            }
            // The entry was removed and built again while this call waited for the lock.
        }
    }
}

impl FolderLock {
    /// Takes a shared lock. Waits while another process removes the folder, which takes a short
    /// time. Returns `None` if there is no folder.
    pub(super) fn shared(folder: &Path) -> Option<Self> {
        match File::open(folder) {
            Ok(file) => Some(Self(file.lock_shared().is_ok().then_some(file))),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(_) => Some(Self(None)),
        }
    }

    /// Takes an exclusive lock. Returns `None` if another process holds the folder, if it cannot be
    /// locked, or if it has been replaced.
    pub(super) fn exclusive(folder: &Path) -> Option<Self> {
        let file = File::open(folder).ok()?;
        file.try_lock().ok()?;
        let hold = Self(Some(file));
        hold.locks_folder(folder).then_some(hold)
    }

    /// Returns whether the locked folder still has this name; true if nothing is locked, because
    /// then nothing is removed.
    fn locks_folder(&self, folder: &Path) -> bool {
        let Some(file) = &self.0 else { return true };
        match (file.metadata(), fs::metadata(folder)) {
            (Ok(held), Ok(named)) => is_same_folder(&held, &named),
            _ => false,
        }
    }

    /// Sets the time of use. This fails if the folder belongs to another user, who sets the time
    /// instead.
    fn touch(&self) {
        if let Some(file) = &self.0 {
            let _ = file.set_modified(SystemTime::now());
        }
    }
}

#[cfg(unix)]
fn is_same_folder(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// Returns true, because other systems do not lock folders.
#[cfg(not(unix))]
fn is_same_folder(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    true
}
