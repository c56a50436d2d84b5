// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder that appears complete or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::staging::StagingError;
use crate::staging::file_list::{self, FileList};
use crate::staging::scratch_folder::{ScratchFolder, remove_leftovers_once};

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
    place: ScratchFolder,
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
        let place = ScratchFolder::beside(parent, name);
        let place = place.map_err(StagingError::unwritable(target))?;
        Ok(Self { user_path: target.to_owned(), target: resolved, place, kind, replace })
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
        file_list::remove_listed(target).map(drop).map_err(StagingError::unwritable(target))
    }

    /// Returns the working folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.place.path()
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
        file_list::write_list(place.path());
        let unwritable = StagingError::unwritable(&user_path);
        // The previous folder is moved away before it is checked, so that no other program writes
        // into it meanwhile. It is removed last, so that one of the two folders always exists.
        let previous = place.previous();
        if let Ok(about) = fs::metadata(&target) {
            fs::set_permissions(place.path(), about.permissions()).map_err(&unwritable)?;
            fs::rename(&target, &previous).map_err(&unwritable)?;
        }
        let replaced = check_replaceable(&previous, &user_path, kind, replace)
            .and_then(|()| fs::rename(place.path(), &target).map_err(&unwritable));
        if let Err(error) = replaced {
            place.restore_previous(&target);
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
    let is_empty = match fs::read_dir(folder) {
        Ok(mut entries) => entries.next().is_none(),
        Err(error) if error.kind() == io::ErrorKind::NotFound => true,
        Err(source) => return Err(failed(source)),
    };
    if is_empty {
        return Ok(());
    }
    if !replace {
        return Err(StagingError::NotEmpty { path: path() });
    }
    if !(kind.matches)(folder) {
        return Err(StagingError::OtherContent { path: path(), what: kind.description });
    }
    let list = FileList::read(folder).map_err(&failed)?;
    let list = list.ok_or_else(|| StagingError::NoList { path: path() })?;
    let files = file_list::files_below(folder).map_err(&failed)?;
    let foreign = list.differences(&files);
    foreign.map_or(Ok(()), |names| Err(StagingError::UnlistedFiles { path: path(), names }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cache_key::sha256_hex;
    use crate::staging::names_in;

    const KIND: FolderKind = FolderKind {
        description: "a test (marker)",
        matches: |folder| folder.join("marker").is_file(),
    };

    fn write(target: &Path, name: &str, replace: bool) -> Result<(), StagingError> {
        let staged = StagedFolder::new(target, KIND, replace)?;
        staged.write(name, b"contents")?;
        staged.commit()
    }

    #[test]
    fn a_folder_appears_whole_or_not_at_all() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("a/b");
        for is_whole in [false, true] {
            let staged = StagedFolder::new(&target, KIND, false).unwrap();
            staged.write("deep/down/file", b"1").unwrap();
            assert!(!target.exists());
            if is_whole {
                staged.commit().unwrap();
            } else {
                drop(staged);
                assert!(names_in(&dir.path().join("a")).is_empty());
            }
        }
        assert_eq!(fs::read(target.join("deep/down/file")).unwrap(), b"1");
        assert_eq!(names_in(&dir.path().join("a")), ["b"]);
    }

    #[test]
    fn only_a_folder_of_the_same_kind_is_replaced_and_only_on_request() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        fs::create_dir(&target).unwrap();
        write(&target, "marker", false).unwrap();
        assert!(matches!(write(&target, "marker", false), Err(StagingError::NotEmpty { .. })));
        write(&target, "other", true).unwrap();
        assert_eq!(names_in(&target), [".foveate", "other"]);
        let refused = write(&target, "marker", true).unwrap_err();
        assert!(refused.to_string().contains("does not hold a test (marker)"), "{refused}");
        assert_eq!(names_in(dir.path()), ["out"]);
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
        assert_eq!(names_in(dir.path()), ["out"]);
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
        assert!(names_in(dir.path()).is_empty());
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
        write_listed(&target).unwrap();
        let list = target.join(".foveate");
        let absolute = elsewhere.join("text").display().to_string();
        let names = ["../thesis/text", &absolute, "link", "folder/text", "folder"];
        let lines = names.map(|name| format!("{}  {name}\n", sha256_hex("thesis"))).concat();
        fs::write(&list, lines + &fs::read_to_string(&list).unwrap()).unwrap();
        symlink(elsewhere.join("text"), target.join("link")).unwrap();
        symlink(&elsewhere, target.join("folder")).unwrap();
        let refused = write_listed(&target).unwrap_err().to_string();
        assert!(refused.contains("folder (changed), link (changed); move them"), "{refused}");
        fs::remove_file(target.join("link")).unwrap();
        fs::remove_file(target.join("folder")).unwrap();
        write_listed(&target).unwrap();
        assert_eq!(fs::read(elsewhere.join("text")).unwrap(), b"thesis");
        // In this case the list itself is a link, and then there is none.
        fs::rename(&list, elsewhere.join("list")).unwrap();
        symlink(elsewhere.join("list"), &list).unwrap();
        assert!(matches!(write_listed(&target), Err(StagingError::NoList { .. })));
        assert!(elsewhere.join("list").is_file());
        fs::remove_file(&list).unwrap();
        assert!(matches!(write_listed(&target), Err(StagingError::NoList { .. })));
        assert_eq!(names_in(&target), ["deep", "marker"]);
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
