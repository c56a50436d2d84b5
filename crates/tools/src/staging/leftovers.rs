// SPDX-License-Identifier: MIT OR Apache-2.0
//! The leftovers of killed processes next to their outputs. The next command that writes there
//! removes a leftover if its lock shows that its process has ended and if it belongs to the same
//! user.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::staging::file_list;
use crate::staging::locked_folder::{LockedFolder, RANDOM_LETTERS, is_own, is_same_file};

/// The prefix of the names of unfinished files of [`write_file`](crate::staging::write_file).
pub const TEMPORARY_PREFIX: &str = ".foveate-";
/// The prefix of the names of folders for intermediate results.
pub(crate) const SCRATCH_PREFIX: &str = "foveate-";
/// The part between the name of an output folder and the random letters, while the folder is
/// written.
const PARTIAL_INFIX: &str = ".partial-";
/// The name of the folder that is being replaced, next to the work folder.
pub(crate) const PREVIOUS_FOLDER: &str = "earlier";

/// Returns the prefix of the name of the folder in which the output `name` is written.
pub(crate) fn partial_prefix(name: &OsStr) -> OsString {
    let mut prefix = OsString::from(".");
    prefix.push(name);
    prefix.push(PARTIAL_INFIX);
    prefix
}

/// Removes the leftovers of killed processes in `folder`, the first time that it is called for this
/// folder. Later calls do nothing, because this process leaves nothing behind while it lives.
pub(crate) fn remove_leftovers_once(folder: &Path) {
    static CLEANED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let is_new = CLEANED.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned());
    if is_new {
        remove_leftovers(folder);
    }
}

fn remove_leftovers(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let (name, path) = (entry.file_name(), entry.path());
        match LeftoverKind::from_name(&name) {
            Some(LeftoverKind::File) => remove_file(&path),
            Some(LeftoverKind::Scratch) => drop(LockedFolder::take_over(&path)),
            Some(LeftoverKind::Partial(target)) => {
                if let Some(leftover) = LockedFolder::take_over(&path) {
                    restore_previous(&leftover, &folder.join(target));
                }
            }
            None => {}
        }
    }
}

#[derive(Debug, PartialEq)]
enum LeftoverKind {
    File,
    Scratch,
    /// The folder of an unfinished output, with the name of the output.
    Partial(OsString),
}

impl LeftoverKind {
    fn from_name(name: &OsStr) -> Option<Self> {
        // Names that are not text are not leftovers.
        let (stem, letters) = name.to_str()?.rsplit_once('-')?;
        if letters.len() != RANDOM_LETTERS
            || !letters.bytes().all(|byte| byte.is_ascii_alphanumeric())
        {
            return None;
        }
        match format!("{stem}-").as_str() {
            TEMPORARY_PREFIX => Some(Self::File),
            SCRATCH_PREFIX => Some(Self::Scratch),
            stem => {
                let target = stem.strip_prefix('.')?.strip_suffix(PARTIAL_INFIX)?;
                (!target.is_empty()).then(|| Self::Partial(target.into()))
            }
        }
    }
}

/// Moves the previous folder, which was about to be replaced, back to `target` if nothing is there.
/// Otherwise the new folder is there, and the listed files of the previous one are removed.
pub(crate) fn restore_previous(locked: &LockedFolder, target: &Path) {
    let previous = locked.sibling(PREVIOUS_FOLDER);
    if !previous.is_dir() {
        return;
    }
    // Both the removal and the move may fail; the folder then stays where it is.
    if fs::symlink_metadata(target).is_ok() {
        let _ = file_list::remove_listed(&previous);
    } else {
        let _ = fs::rename(&previous, target);
    }
}

/// Removes a temporary file unless the process that writes it still holds its lock.
fn remove_file(path: &Path) {
    if !fs::symlink_metadata(path).is_ok_and(|about| about.is_file() && is_own(&about)) {
        return;
    }
    let Ok(file) = OpenOptions::new().write(true).open(path) else { return };
    if file.try_lock().is_ok() && is_same_file(&file, path) {
        let _ = fs::remove_file(path);
    }
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;
    use crate::staging::locked_folder::LOCK_FILE;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn the_name_of_a_leftover_shows_its_kind() {
        let kind = |name: &str| LeftoverKind::from_name(OsStr::new(name));
        assert_eq!(kind(".foveate-0123456789"), Some(LeftoverKind::File));
        assert_eq!(kind("foveate-abcdefghij"), Some(LeftoverKind::Scratch));
        assert_eq!(kind(".a-b.partial-abcdefghij"), Some(LeftoverKind::Partial("a-b".into())));
        for name in [
            ".foveate-backup",
            ".foveate-0123456.89",
            "out.partial-0123456789",
            ".foveate",
            "..partial-0123456789",
        ] {
            assert_eq!(kind(name), None, "{name}");
        }
    }

    /// Makes a folder as a killed process leaves it, with all files but without a held lock.
    fn make_killed_leftover(parent: &Path, name: &str) -> PathBuf {
        let leftover = LockedFolder::create(parent, &partial_prefix(OsStr::new(name))).unwrap();
        fs::write(leftover.work().join("half"), "half").unwrap();
        let root = leftover.work().parent().unwrap().to_owned();
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
        let living = LockedFolder::create(parent, &partial_prefix(OsStr::new("out"))).unwrap();
        let root = make_killed_leftover(parent, "out");
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
        fs::write(parent.join(".foveate-abcdefghij"), "half").unwrap();
        let before = names(parent).len();
        remove_leftovers(parent);
        assert!(!root.exists() && !parent.join(".foveate-abcdefghij").exists());
        assert_eq!(names(parent).len(), before - 2, "{:?}", names(parent));
        let linked_file = parent.join("target").join("work").join("half");
        assert!(living.work().is_dir() && linked_file.is_file());
    }

    #[test]
    fn a_previous_folder_is_restored_unless_the_new_one_is_in_place() {
        let dir = tempfile::tempdir().unwrap();
        let root = make_killed_leftover(dir.path(), "out");
        fs::create_dir(root.join(PREVIOUS_FOLDER)).unwrap();
        fs::write(root.join(PREVIOUS_FOLDER).join("result"), "result").unwrap();
        remove_leftovers(dir.path());
        assert_eq!(names(dir.path()), ["out"]);
        assert_eq!(fs::read(dir.path().join("out/result")).unwrap(), b"result");
        // The new folder is in its place, so the listed files of the previous one are removed.
        let root = make_killed_leftover(dir.path(), "out");
        let previous = root.join(PREVIOUS_FOLDER);
        fs::create_dir(&previous).unwrap();
        fs::write(previous.join("listed"), "listed").unwrap();
        file_list::write_list(&previous);
        fs::write(previous.join("mine"), "mine").unwrap();
        remove_leftovers(dir.path());
        assert_eq!(names(&previous), [".foveate", "mine"]);
        fs::remove_file(previous.join("mine")).unwrap();
        remove_leftovers(dir.path());
        assert_eq!(names(dir.path()), ["out"]);
    }
}
