// SPDX-License-Identifier: MIT OR Apache-2.0
//! Entries that are in use. A process that uses one holds a shared lock of its folder; one that removes it
//! needs an exclusive lock. The system gives up the locks of a process that ends, however it ends.

use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::trust;

/// A file of the cache, which is there as long as this lives.
#[derive(Debug)]
pub struct Entry {
    path: PathBuf,
    _hold: Hold,
}

/// A lock of a folder; nothing on a system or file system that does not lock folders, which removes
/// nothing either.
#[derive(Debug)]
pub(super) struct Hold(Option<File>);

impl Entry {
    pub(super) fn new(path: PathBuf, hold: Hold) -> Self {
        Self { path, _hold: hold }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The entry in the folder `place`, if it is there, used from now on.
    pub(super) fn take(place: &Path, artifact: &str) -> Option<Self> {
        let path = place.join(artifact);
        loop {
            let hold = Hold::shared(place)?;
            if !path.exists() || !trust::is_entry(place, artifact) {
                return None;
            }
            if hold.is_of(place) {
                hold.touch();
                return Some(Self { path, _hold: hold });
            }
            // It was removed, and built again, while we waited for the lock.
        }
    }
}

impl Hold {
    /// Waits while somebody removes the folder, which is soon done. Nothing where there is no folder.
    pub(super) fn shared(folder: &Path) -> Option<Self> {
        match File::open(folder) {
            Ok(file) => Some(Self(file.lock_shared().is_ok().then_some(file))),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(_) => Some(Self(None)),
        }
    }

    /// Nothing where somebody else holds the folder, or it cannot be locked, or it is another by now.
    pub(super) fn exclusive(folder: &Path) -> Option<Self> {
        let file = File::open(folder).ok()?;
        file.try_lock().ok()?;
        let hold = Self(Some(file));
        hold.is_of(folder).then_some(hold)
    }

    /// Whether what is locked still stands under this name; where nothing is locked nothing is removed.
    fn is_of(&self, folder: &Path) -> bool {
        let Some(file) = &self.0 else { return true };
        match (file.metadata(), fs::metadata(folder)) {
            (Ok(held), Ok(named)) => same(&held, &named),
            _ => false,
        }
    }

    /// Notes the time of use. It may belong to somebody else, who then notes it.
    fn touch(&self) {
        if let Some(file) = &self.0 {
            let _ = file.set_modified(SystemTime::now());
        }
    }
}

#[cfg(unix)]
fn same(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// Folders are not locked elsewhere.
#[cfg(not(unix))]
fn same(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    true
}
