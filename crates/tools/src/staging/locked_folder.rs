// SPDX-License-Identifier: MIT OR Apache-2.0
//! A private folder for work in progress. Its lock tells other processes whether its process still
//! lives. The system releases the locks of a process that ends, in whatever way it ends, on this
//! machine and on others that share the file system.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

pub(crate) const LOCK_FILE: &str = ".foveate-lock";
/// The content of the locked file. A folder without it was not made by this crate.
const LOCK_TEXT: &[u8] = b"Foveate works in this folder while this file is locked.\n";
const WORK_FOLDER: &str = "work";
/// The number of random letters and digits at the end of a name.
pub(crate) const RANDOM_LETTERS: usize = 10;

/// A locked folder. It is removed with the work in it when it is dropped.
#[derive(Debug)]
pub(crate) struct LockedFolder {
    root: PathBuf,
    work: PathBuf,
    lock: Option<File>,
}

impl LockedFolder {
    /// Creates a folder in `parent` whose name begins with `prefix`. Only its owner can enter it.
    pub(crate) fn create(parent: &Path, prefix: &std::ffi::OsStr) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(prefix).rand_bytes(RANDOM_LETTERS);
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let root = builder.tempdir_in(parent).map_err(|error| without_path(&error))?;
        let mut lock = File::create_new(root.path().join(LOCK_FILE))?;
        // The call waits while another process inspects the folder. If files cannot be locked, no
        // process treats this folder as a leftover, because none gets the lock.
        let _ = lock.lock();
        lock.write_all(LOCK_TEXT)?;
        let work = root.path().join(WORK_FOLDER);
        fs::create_dir(&work)?;
        Ok(Self { root: root.keep(), work, lock: Some(lock) })
    }

    /// Takes over the folder of a process that has ended, if `root` is such a folder and belongs to
    /// this user.
    pub(crate) fn take_over(root: &Path) -> Option<Self> {
        let path = root.join(LOCK_FILE);
        let own = |about: &fs::Metadata| is_own(about);
        let is_folder = fs::symlink_metadata(root).is_ok_and(|about| about.is_dir() && own(&about));
        let is_file = fs::symlink_metadata(&path).is_ok_and(|about| about.is_file() && own(&about));
        if !is_folder || !is_file {
            return None;
        }
        let lock = OpenOptions::new().read(true).write(true).open(&path).ok()?;
        lock.try_lock().ok()?;
        let mut text = Vec::new();
        (&lock).take(LOCK_TEXT.len() as u64 + 1).read_to_end(&mut text).ok()?;
        // The previous process may have removed the file between the checks and the lock.
        let is_same = is_same_file(&lock, &path);
        (text == LOCK_TEXT && is_same).then(|| Self {
            root: root.to_owned(),
            work: root.join(WORK_FOLDER),
            lock: Some(lock),
        })
    }

    pub(crate) fn work(&self) -> &Path {
        &self.work
    }

    /// Returns a path next to the folder for the work.
    pub(crate) fn sibling(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }
}

impl Drop for LockedFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.work);
        // Other files keep the folder and its lock, so that the next run handles them.
        let others = fs::read_dir(&self.root).into_iter().flatten().flatten();
        if others.filter(|entry| entry.file_name() != LOCK_FILE).count() == 0 {
            let _ = fs::remove_file(self.root.join(LOCK_FILE));
            drop(self.lock.take());
            let _ = fs::remove_dir(&self.root);
        }
    }
}

/// Returns the error of a temporary file without the name of that file, which the user did not
/// choose.
pub(crate) fn without_path(error: &io::Error) -> io::Error {
    let inner = error.get_ref().and_then(|inner| inner.source());
    let code = error.raw_os_error().or_else(|| {
        inner.and_then(|inner| inner.downcast_ref::<io::Error>()).and_then(io::Error::raw_os_error)
    });
    code.map_or_else(|| io::Error::from(error.kind()), io::Error::from_raw_os_error)
}

/// Returns whether a file belongs to the user of this process.
#[cfg(unix)]
pub(crate) fn is_own(about: &fs::Metadata) -> bool {
    std::os::unix::fs::MetadataExt::uid(about) == rustix::process::geteuid().as_raw()
}

/// Returns false: other systems do not report the owner, so nothing is treated as a leftover.
#[cfg(not(unix))]
pub(crate) fn is_own(_: &fs::Metadata) -> bool {
    false
}

/// Returns whether an open file still has this name.
#[cfg(unix)]
pub(crate) fn is_same_file(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let identity = |about: fs::Metadata| (about.dev(), about.ino());
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(open), Ok(named)) => identity(open) == identity(named),
        _ => false,
    }
}

/// Returns whether the path exists, because on other systems an open file cannot be removed.
#[cfg(not(unix))]
pub(crate) fn is_same_file(_: &File, path: &Path) -> bool {
    path.exists()
}
