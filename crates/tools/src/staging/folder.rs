// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder that appears complete or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::staging::StagingError;
use crate::staging::file_list::{self, FileList, first_names};
use crate::staging::leftovers::{
    PREVIOUS_FOLDER, partial_prefix, remove_leftovers_once, restore_previous,
};
use crate::staging::locked_folder::LockedFolder;

/// The kind of an output folder, which identifies folders that may be replaced. A folder of any
/// kind is replaced only if every file in it is on its list, `.foveate`, and unchanged.
#[derive(Clone, Copy, Debug)]
pub struct FolderKind {
    /// The description with its article, for messages: `a simulation (summary.json)`.
    pub description: &'static str,
    /// A function that returns whether an existing folder is of this kind.
    pub matches: fn(&Path) -> bool,
}

/// An output folder that is being written. It is removed if it is dropped before
/// [`StagedFolder::commit`].
#[derive(Debug)]
pub struct StagedFolder {
    /// The path as the user gave it.
    user_path: PathBuf,
    target: PathBuf,
    place: LockedFolder,
    kind: FolderKind,
    replace: bool,
}

impl StagedFolder {
    /// Checks that `target` may be written and creates the working folder next to it. Missing
    /// parent folders are created, too. An existing folder of the same kind is replaced if
    /// `replace` is set.
    ///
    /// # Errors
    /// Fails if `target` has contents that may not be replaced, or cannot be written.
    pub fn new(target: &Path, kind: FolderKind, replace: bool) -> Result<Self, StagingError> {
        let invalid_path = || StagingError::InvalidPath { path: target.to_owned() };
        let absolute = std::path::absolute(target).map_err(|_| invalid_path())?;
        let resolved = absolute.canonicalize().unwrap_or(absolute);
        let (Some(parent), Some(name)) = (resolved.parent(), resolved.file_name()) else {
            return Err(invalid_path());
        };
        // A killed run may have moved the existing folder away; it is restored first.
        remove_leftovers_once(parent);
        check_replaceable(&resolved, target, kind, replace)?;
        fs::create_dir_all(parent).map_err(StagingError::unwritable(target))?;
        let locked = LockedFolder::create(parent, &partial_prefix(name));
        let locked = locked.map_err(StagingError::unwritable(target))?;
        Ok(Self { user_path: target.to_owned(), target: resolved, place: locked, kind, replace })
    }

    /// Checks whether [`StagedFolder::new`] would accept `target`, without creating anything, so
    /// that a run can fail before hours of work.
    ///
    /// # Errors
    /// Fails if `target` has contents that may not be replaced.
    pub fn check(target: &Path, kind: FolderKind, replace: bool) -> Result<(), StagingError> {
        check_replaceable(target, target, kind, replace)
    }

    /// Removes a folder that [`StagedFolder::new`] would replace, if it exists.
    ///
    /// # Errors
    /// Fails if `target` has contents that may not be removed, or cannot be removed.
    pub fn remove(target: &Path, kind: FolderKind) -> Result<(), StagingError> {
        check_replaceable(target, target, kind, true)?;
        if !target.is_dir() {
            return Ok(());
        }
        file_list::remove_listed(target).map(drop).map_err(StagingError::unwritable(target))
    }

    /// Returns the working folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.place.work()
    }

    /// Converts a path in [`StagedFolder::folder`] to the path that the user will see.
    #[must_use]
    pub fn shown_path(&self, path: &Path) -> PathBuf {
        match path.strip_prefix(self.folder()) {
            Ok(below) if below.as_os_str().is_empty() => self.user_path.clone(),
            Ok(below) => self.user_path.join(below),
            Err(_) => path.to_owned(),
        }
    }

    /// Converts the paths in a program's message to those that the user will see.
    #[must_use]
    pub fn with_shown_paths(&self, text: &str) -> String {
        text.replace(&*self.folder().to_string_lossy(), &self.user_path.to_string_lossy())
    }

    /// Converts the path in an error to the path that the user will see.
    #[must_use]
    pub fn with_shown_path(&self, error: StagingError) -> StagingError {
        match error {
            StagingError::Unwritable { path, source } => {
                StagingError::Unwritable { path: self.shown_path(&path), source }
            }
            other => other,
        }
    }

    /// Writes a file of the folder, and creates the folders above it.
    ///
    /// # Errors
    /// Fails if the file cannot be written.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<(), StagingError> {
        let path = self.folder().join(name);
        let shown = self.user_path.join(name);
        let unwritable = StagingError::unwritable(&shown);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(&unwritable)?;
        }
        fs::write(&path, contents).map_err(&unwritable)
    }

    /// Moves the folder to its place.
    ///
    /// # Errors
    /// Fails if another folder has appeared in that place meanwhile, or if the place cannot be
    /// written.
    pub fn commit(self) -> Result<(), StagingError> {
        let Self { user_path, target, place, kind, replace } = self;
        file_list::write_list(place.work());
        let unwritable = StagingError::unwritable(&user_path);
        let Ok(previous_mode) = fs::metadata(&target).map(|about| about.permissions()) else {
            return fs::rename(place.work(), &target).map_err(unwritable);
        };
        fs::set_permissions(place.work(), previous_mode).map_err(&unwritable)?;
        // The previous folder is moved away before it is checked, so that no other program writes
        // into it meanwhile. It is removed last, so that one of the two folders always exists.
        let previous = place.sibling(PREVIOUS_FOLDER);
        fs::rename(&target, &previous).map_err(&unwritable)?;
        let replaced = check_replaceable(&previous, &user_path, kind, replace)
            .and_then(|()| fs::rename(place.work(), &target).map_err(&unwritable));
        if let Err(error) = replaced {
            restore_previous(&place, &target);
            return Err(error);
        }
        match file_list::remove_listed(&previous) {
            Ok(true) => Ok(()),
            Ok(false) => Err(StagingError::FilesKept { path: user_path.clone(), kept: previous }),
            Err(source) => Err(StagingError::Unwritable { path: previous, source }),
        }
    }
}

/// Fails if a folder may not be replaced. A missing or empty folder may always be replaced. Any
/// other folder may be replaced only on request, if it is of the same kind and has no files of the
/// user. `shown` is the path for messages.
fn check_replaceable(
    folder: &Path,
    shown: &Path,
    kind: FolderKind,
    replace: bool,
) -> Result<(), StagingError> {
    let path = || shown.to_owned();
    let failed = StagingError::unwritable(shown);
    let mut entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(failed(source)),
    };
    if entries.next().is_none() {
        return Ok(());
    }
    match (replace, (kind.matches)(folder)) {
        (false, _) => return Err(StagingError::NotEmpty { path: path() }),
        (true, false) => {
            return Err(StagingError::OtherContent { path: path(), what: kind.description });
        }
        (true, true) => {}
    }
    let list = FileList::read(folder).map_err(&failed)?;
    let Some(list) = list else { return Err(StagingError::NoList { path: path() }) };
    let found = file_list::files_below(folder).map_err(&failed)?;
    let foreign: Vec<String> =
        found.iter().filter_map(|file| list.difference(&file.name, &file.path)).collect();
    if foreign.is_empty() {
        return Ok(());
    }
    Err(StagingError::UnlistedFiles { path: path(), names: first_names(&foreign) })
}

#[cfg(test)]
mod tests {
    use super::*;

    const KIND: FolderKind = FolderKind {
        description: "a test (marker)",
        matches: |folder| folder.join("marker").is_file(),
    };

    fn write(target: &Path, name: &str, replace: bool) -> Result<(), StagingError> {
        let staged = StagedFolder::new(target, KIND, replace)?;
        staged.write(name, b"contents")?;
        staged.commit()
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_folder_appears_whole() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("a/b");
        let staged = StagedFolder::new(&target, KIND, false).unwrap();
        staged.write("deep/down/file", b"1").unwrap();
        assert!(!target.exists());
        staged.commit().unwrap();
        assert_eq!(fs::read(target.join("deep/down/file")).unwrap(), b"1");
        assert_eq!(names(&dir.path().join("a")), ["b"]);
    }

    #[test]
    fn a_dropped_folder_leaves_nothing() {
        let dir = tempfile::tempdir().unwrap();
        let staged = StagedFolder::new(&dir.path().join("out"), KIND, false).unwrap();
        staged.write("file", b"1").unwrap();
        drop(staged);
        assert!(names(dir.path()).is_empty());
    }

    #[test]
    fn only_a_folder_of_the_same_kind_is_replaced_and_only_on_request() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        fs::create_dir(&target).unwrap();
        write(&target, "marker", false).unwrap();
        assert!(matches!(write(&target, "marker", false), Err(StagingError::NotEmpty { .. })));
        write(&target, "other", true).unwrap();
        assert_eq!(names(&target), [".foveate", "other"]);
        let refused = write(&target, "marker", true).unwrap_err();
        assert!(refused.to_string().contains("does not hold a test (marker)"), "{refused}");
        assert_eq!(names(dir.path()), ["out"]);
    }

    /// Writes a marker and a file whose name needs escaping.
    fn write_listed(target: &Path) -> Result<(), StagingError> {
        let staged = StagedFolder::new(target, KIND, true)?;
        staged.write("marker", b"contents")?;
        staged.write("deep/100 %\n# é", b"contents")?;
        staged.commit()
    }

    #[test]
    fn a_folder_is_replaced_only_if_every_file_in_it_is_listed() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        write_listed(&target).unwrap();
        write_listed(&target).unwrap();
        // Missing files and folders without files do not prevent the replacement.
        fs::remove_dir_all(target.join("deep")).unwrap();
        fs::create_dir(target.join("empty")).unwrap();
        write_listed(&target).unwrap();
        for name in ["notes", "deep/notes", "deep/.foveate", "a", "#b"] {
            fs::write(target.join(name), "mine").unwrap();
        }
        let refused = write_listed(&target).unwrap_err().to_string();
        assert!(refused.contains("#b, a, deep/.foveate and 2 more; move them"), "{refused}");
        assert!(StagedFolder::check(&target, KIND, true).is_err());
        assert_eq!(fs::read(target.join("deep/notes")).unwrap(), b"mine");
        assert_eq!(names(dir.path()), ["out"]);
    }

    #[test]
    fn a_listed_file_that_was_changed_stays() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        write_listed(&target).unwrap();
        fs::write(target.join("marker"), "contentz").unwrap();
        let refused = write_listed(&target).unwrap_err().to_string();
        assert!(refused.contains("marker (changed); move them"), "{refused}");
        assert!(StagedFolder::remove(&target, KIND).is_err());
        assert_eq!(fs::read(target.join("marker")).unwrap(), b"contentz");
        fs::write(target.join("marker"), "contents").unwrap();
        StagedFolder::remove(&target, KIND).unwrap();
        StagedFolder::remove(&target, KIND).unwrap();
        assert!(names(dir.path()).is_empty());
    }

    /// A list that names files elsewhere, by paths and through links, affects none of them.
    #[cfg(unix)]
    #[test]
    fn a_forged_list_deletes_nothing_elsewhere() {
        use std::os::unix::fs::symlink;
        let dir = tempfile::tempdir().unwrap();
        let (target, elsewhere) = (dir.path().join("out"), dir.path().join("thesis"));
        fs::create_dir(&elsewhere).unwrap();
        fs::write(elsewhere.join("text"), "thesis").unwrap();
        let line = |name: &str| {
            format!("{}  {name}\n", String::from_utf8(file_list::hash(b"thesis")).unwrap())
        };
        let write_forged_list = |names: &[&str]| {
            let text: String = names.iter().map(|name| line(name)).collect();
            fs::write(target.join(".foveate"), text).unwrap();
        };
        write_listed(&target).unwrap();
        let true_list = fs::read_to_string(target.join(".foveate")).unwrap();
        let absolute = elsewhere.join("text").display().to_string();
        let names = ["../thesis/text", &absolute, "link", "folder/text", "folder"];
        fs::write(
            target.join(".foveate"),
            names.iter().map(|name| line(name)).collect::<String>() + &true_list,
        )
        .unwrap();
        symlink(elsewhere.join("text"), target.join("link")).unwrap();
        symlink(&elsewhere, target.join("folder")).unwrap();
        let refused = write_listed(&target).unwrap_err().to_string();
        assert!(refused.contains("folder (changed), link (changed); move them"), "{refused}");
        fs::remove_file(target.join("link")).unwrap();
        fs::remove_file(target.join("folder")).unwrap();
        write_listed(&target).unwrap();
        assert_eq!(fs::read(elsewhere.join("text")).unwrap(), b"thesis");
        // In this case the list itself is a link.
        write_forged_list(&["marker"]);
        fs::rename(target.join(".foveate"), elsewhere.join("list")).unwrap();
        symlink(elsewhere.join("list"), target.join(".foveate")).unwrap();
        assert!(matches!(write_listed(&target), Err(StagingError::NoList { .. })));
        assert!(elsewhere.join("list").is_file());
    }

    #[cfg(unix)]
    #[test]
    fn a_new_folder_has_the_usual_mode_and_a_replaced_one_keeps_its_mode() {
        use std::os::unix::fs::PermissionsExt as _;
        let dir = tempfile::tempdir().unwrap();
        let (target, plain) = (dir.path().join("out"), dir.path().join("plain"));
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;
        fs::create_dir(&plain).unwrap();
        write_listed(&target).unwrap();
        assert_eq!(mode(&target), mode(&plain));
        fs::set_permissions(&target, fs::Permissions::from_mode(0o710)).unwrap();
        write_listed(&target).unwrap();
        assert_eq!(mode(&target), 0o710);
    }

    #[test]
    fn messages_name_the_folder_that_the_user_gave() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        let staged = StagedFolder::new(&target, KIND, false).unwrap();
        let inside = staged.folder().join("a/b");
        assert_eq!(staged.shown_path(&inside), target.join("a/b"));
        assert_eq!(staged.shown_path(staged.folder()), target);
        assert_eq!(staged.shown_path(Path::new("/else")), Path::new("/else"));
        let message = staged.with_shown_paths(&format!("no room for {}", inside.display()));
        assert_eq!(message, format!("no room for {}", target.join("a/b").display()));
    }

    #[test]
    fn a_folder_without_its_list_is_not_replaced() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        write_listed(&target).unwrap();
        fs::remove_file(target.join(".foveate")).unwrap();
        assert!(matches!(write_listed(&target), Err(StagingError::NoList { .. })));
        assert_eq!(names(&target), ["deep", "marker"]);
    }

    #[test]
    fn an_error_names_the_path_that_cannot_be_written() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("file"), "").unwrap();
        for target in ["file", "file/out"] {
            let error = write(&dir.path().join(target), "x", false).unwrap_err().to_string();
            assert!(error.contains(&format!("{target}`")), "{error}");
        }
        assert!(matches!(write(Path::new("/"), "x", false), Err(StagingError::InvalidPath { .. })));
    }
}
