// SPDX-License-Identifier: MIT OR Apache-2.0
//! Folders and files for work in progress, which are locked while their process lives. The system
//! releases the locks of a process that ends, in whatever way it ends, on this machine and on
//! others that share the file system. So the next command of the same user that writes beside them
//! can remove what a killed process left.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::NamedTempFile;

use crate::staging::file_list;

/// The prefix of the names of unfinished files of [`write_file`](crate::staging::write_file).
pub const TEMPORARY_PREFIX: &str = ".foveate-";
/// The prefix of the names of folders among the temporary files of the system.
const SCRATCH_PREFIX: &str = "foveate-";
/// The part between the name of an output folder and the random letters, while it is written.
const PARTIAL_INFIX: &str = ".partial-";
/// The number of random letters and digits at the end of these names.
const RANDOM_LETTERS: usize = 10;
const LOCK_FILE: &str = ".foveate-lock";
/// The content of the locked file. A folder without it was not made by this crate.
const LOCK_TEXT: &[u8] = b"Foveate works in this folder while this file is locked.\n";
const WORK_FOLDER: &str = "work";
/// The name of the folder that is being replaced, next to the work folder.
const PREVIOUS_FOLDER: &str = "earlier";

/// A temporary folder that is removed when it is dropped. The folder of a killed process is removed
/// when the next one is created.
#[derive(Debug)]
pub struct ScratchFolder {
    root: PathBuf,
    work: PathBuf,
    /// The locked file, once there is one.
    lock: Option<File>,
}

impl ScratchFolder {
    /// Creates the folder in the system's folder of temporary files.
    ///
    /// # Errors
    /// Fails if that folder cannot be written.
    pub fn new() -> io::Result<Self> {
        Self::create(&std::env::temp_dir(), OsStr::new(SCRATCH_PREFIX))
    }

    /// Creates the folder in which the output `name` of `parent` is written.
    pub(crate) fn beside(parent: &Path, name: &OsStr) -> io::Result<Self> {
        let mut prefix = OsString::from(".");
        prefix.push(name);
        prefix.push(PARTIAL_INFIX);
        Self::create(parent, &prefix)
    }

    /// Creates a folder that only its owner can enter.
    fn create(parent: &Path, prefix: &OsStr) -> io::Result<Self> {
        remove_leftovers_once(parent);
        let mut private = fs::DirBuilder::new();
        #[cfg(unix)]
        std::os::unix::fs::DirBuilderExt::mode(&mut private, 0o700);
        let ((), root) = create_named(parent, prefix, |path| private.create(path))?.keep()?;
        let mut folder = Self { work: root.join(WORK_FOLDER), root, lock: None };
        let lock = folder.lock.insert(File::create_new(folder.root.join(LOCK_FILE))?);
        // The call waits while another process inspects the folder. If files cannot be locked, no
        // process treats this folder as a leftover, because none gets the lock.
        let _ = lock.lock();
        lock.write_all(LOCK_TEXT)?;
        fs::create_dir(&folder.work)?;
        Ok(folder)
    }

    /// Takes over the folder of a process that has ended, if `root` is such a folder.
    fn take_over(root: PathBuf) -> Option<Self> {
        let path = root.join(LOCK_FILE);
        let lock = lock_of_ended_process(&path)?;
        let is_ours = fs::read(&path).ok()? == LOCK_TEXT;
        is_ours.then(|| Self { work: root.join(WORK_FOLDER), root, lock: Some(lock) })
    }

    /// Returns the path of the folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.work
    }

    /// Returns the place of the folder that is being replaced.
    pub(crate) fn previous(&self) -> PathBuf {
        self.root.join(PREVIOUS_FOLDER)
    }

    /// Moves the previous folder, which was about to be replaced, back to `target` if nothing is
    /// there. Otherwise the new folder is there, and the listed files of the previous one are
    /// removed.
    pub(crate) fn restore_previous(&self, target: &Path) {
        // Both the removal and the move may fail; the folder then stays where it is.
        if fs::symlink_metadata(target).is_ok() {
            let _ = file_list::remove_listed(&self.previous());
        } else {
            let _ = fs::rename(self.previous(), target);
        }
    }
}

impl Drop for ScratchFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.work);
        // A previous folder keeps the folder and its lock, so that the next run handles it.
        if !self.previous().exists() {
            let _ = fs::remove_file(self.root.join(LOCK_FILE));
            drop(self.lock.take());
            let _ = fs::remove_dir(&self.root);
        }
    }
}

/// Creates a file with a temporary name and this mode. It is locked, so that no other process
/// removes it as a leftover.
pub(crate) fn create_locked_file(folder: &Path, mode: u32) -> io::Result<NamedTempFile> {
    remove_leftovers_once(folder);
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, mode);
    #[cfg(not(unix))]
    let _ = mode;
    // Another process may remove the file before it is locked. Then a new one is made.
    loop {
        let file = create_named(folder, OsStr::new(TEMPORARY_PREFIX), |path| options.open(path))?;
        // If files cannot be locked, no other process removes this file either.
        let _ = file.as_file().lock();
        if is_same_file(file.as_file(), file.path()) {
            return Ok(file);
        }
    }
}

/// Creates something with a new name, which begins with `prefix`. Unlike other functions of
/// `tempfile` this one adds nothing to the errors of the system.
fn create_named<T>(
    parent: &Path,
    prefix: &OsStr,
    create: impl FnMut(&Path) -> io::Result<T>,
) -> io::Result<NamedTempFile<T>> {
    tempfile::Builder::new().prefix(prefix).rand_bytes(RANDOM_LETTERS).make_in(parent, create)
}

/// Removes the leftovers of killed processes in `folder`, the first time that it is called for this
/// folder. Later calls do nothing, because this process leaves nothing behind while it lives.
pub(crate) fn remove_leftovers_once(folder: &Path) {
    static CLEANED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    if CLEANED.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned()) {
        remove_leftovers(folder);
    }
}

fn remove_leftovers(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let (name, path) = (entry.file_name(), entry.path());
        // Names that are not text are not leftovers.
        let Some((stem, letters)) = name.to_str().and_then(|name| name.rsplit_once('-')) else {
            continue;
        };
        let is_random = letters.bytes().all(|byte| byte.is_ascii_alphanumeric());
        if letters.len() != RANDOM_LETTERS || !is_random {
            continue;
        }
        // A link is neither a file nor a folder.
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if !is_folder && TEMPORARY_PREFIX.strip_suffix('-') == Some(stem) {
            if let Some(_lock) = lock_of_ended_process(&path) {
                let _ = fs::remove_file(&path);
            }
        } else if is_folder && let Some(leftover) = ScratchFolder::take_over(path) {
            let target = format!("{stem}-");
            let target = target.strip_prefix('.').and_then(|name| name.strip_suffix(PARTIAL_INFIX));
            if let Some(target) = target {
                leftover.restore_previous(&folder.join(target));
            }
        }
    }
}

/// Locks a file of this user, unless the process that made it still holds its lock.
fn lock_of_ended_process(path: &Path) -> Option<File> {
    let about = fs::symlink_metadata(path).ok()?;
    if !about.is_file() || !is_own(&about) {
        return None;
    }
    let file = OpenOptions::new().write(true).open(path).ok()?;
    file.try_lock().ok()?;
    // The other process may have removed the file before it was locked.
    is_same_file(&file, path).then_some(file)
}

/// Returns whether a file belongs to the user of this process.
#[cfg(unix)]
fn is_own(about: &fs::Metadata) -> bool {
    std::os::unix::fs::MetadataExt::uid(about) == rustix::process::geteuid().as_raw()
}

/// Returns false: other systems do not report the owner, so nothing is treated as a leftover.
#[cfg(not(unix))]
fn is_own(_: &fs::Metadata) -> bool {
    false
}

/// Returns whether an open file still has this name.
#[cfg(unix)]
fn is_same_file(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let identity = |about: fs::Metadata| (about.dev(), about.ino());
    file.metadata().ok().map(identity) == fs::symlink_metadata(path).ok().map(identity)
}

/// Returns whether the path exists, because on other systems an open file cannot be removed.
#[cfg(not(unix))]
fn is_same_file(_: &File, path: &Path) -> bool {
    path.exists()
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;
    use crate::staging::names_in;

    #[test]
    fn a_scratch_folder_is_removed_with_its_value() {
        let scratch = ScratchFolder::new().unwrap();
        let root = scratch.root.clone();
        fs::write(scratch.path().join("file"), "contents").unwrap();
        drop(scratch);
        assert!(!root.exists());
    }

    /// Makes a folder as a killed process leaves it, with all files but without a held lock.
    fn make_killed_leftover(parent: &Path, name: &str) -> PathBuf {
        let leftover = ScratchFolder::beside(parent, OsStr::new(name)).unwrap();
        fs::write(leftover.path().join("half"), "half").unwrap();
        let root = leftover.root.clone();
        let parked = parent.join("kept");
        fs::rename(&root, &parked).unwrap();
        drop(leftover);
        fs::rename(&parked, &root).unwrap();
        root
    }

    #[test]
    fn only_leftovers_of_ended_processes_are_removed() {
        let dir = tempfile::tempdir().unwrap();
        let parent = dir.path();
        let living = ScratchFolder::beside(parent, OsStr::new("out")).unwrap();
        let living_file = create_locked_file(parent, 0o600).unwrap();
        let (root, hyphened) =
            (make_killed_leftover(parent, "out"), make_killed_leftover(parent, "a-b"));
        assert!(root.join("work/half").is_file());
        // These folders belong to the user: one without a lock, one with another file of that name,
        // and one that is a link.
        for name in [".mine.partial-0123456789", ".other.partial-0123456789"] {
            fs::create_dir_all(parent.join(name).join("work")).unwrap();
        }
        fs::write(parent.join(".other.partial-0123456789").join(LOCK_FILE), "my notes").unwrap();
        let linked = make_killed_leftover(parent, "linked");
        fs::rename(&linked, parent.join("target")).unwrap();
        std::os::unix::fs::symlink(parent.join("target"), &linked).unwrap();
        for name in [".foveate-abcdefghij", ".foveate-backup", ".foveate-0123456.89", ".foveate"] {
            fs::write(parent.join(name), "half").unwrap();
        }
        let mut left = names_in(parent);
        let removed = [&root, &hyphened].map(|path| path.file_name().unwrap().to_owned());
        left.retain(|name| !removed.contains(&name.into()) && name != ".foveate-abcdefghij");
        remove_leftovers(parent);
        assert_eq!(names_in(parent), left);
        assert!(living.path().is_dir() && living_file.path().is_file());
        assert!(parent.join("target/work/half").is_file());
    }

    #[test]
    fn a_previous_folder_is_restored_unless_the_new_one_is_in_place() {
        let dir = tempfile::tempdir().unwrap();
        let root = make_killed_leftover(dir.path(), "out");
        fs::create_dir(root.join(PREVIOUS_FOLDER)).unwrap();
        fs::write(root.join(PREVIOUS_FOLDER).join("result"), "result").unwrap();
        remove_leftovers(dir.path());
        assert_eq!(names_in(dir.path()), ["out"]);
        assert_eq!(fs::read(dir.path().join("out/result")).unwrap(), b"result");
        // The new folder is in its place, so the listed files of the previous one are removed.
        let root = make_killed_leftover(dir.path(), "out");
        let previous = root.join(PREVIOUS_FOLDER);
        fs::create_dir(&previous).unwrap();
        fs::write(previous.join("listed"), "listed").unwrap();
        file_list::write_list(&previous);
        fs::write(previous.join("mine"), "mine").unwrap();
        remove_leftovers(dir.path());
        assert_eq!(names_in(&previous), [".foveate", "mine"]);
        fs::remove_file(previous.join("mine")).unwrap();
        remove_leftovers(dir.path());
        assert_eq!(names_in(dir.path()), ["out"]);
    }
}
