// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder, whole or not there.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::{StagingError, list};

/// What kind of folder is written, to recognize one that may be replaced.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// With its article, for messages: `a simulation (summary.json)`.
    pub what: &'static str,
    /// Whether a folder that is there is of this kind.
    pub is: fn(&Path) -> bool,
    /// Whether it holds a list of its files, `.foveate`, and makes way only if it holds no others.
    pub listed: bool,
}

/// A folder in the making; dropped before [`StagedFolder::commit`] it is removed.
#[derive(Debug)]
pub struct StagedFolder {
    target: PathBuf,
    partial: PathBuf,
    kind: Kind,
    replace: bool,
}

impl StagedFolder {
    /// Checks that `target` may be written and makes the folder beside it; folders above it that
    /// are missing are made too. A folder of the same kind makes way if `replace` is set.
    ///
    /// # Errors
    /// When `target` holds something that does not make way, or cannot be written.
    pub fn new(target: &Path, kind: Kind, replace: bool) -> Result<Self, StagingError> {
        let unnamed = || StagingError::NoName { path: target.to_owned() };
        let place = std::path::absolute(target).map_err(|_| unnamed())?;
        let place = place.canonicalize().unwrap_or(place);
        let (Some(parent), Some(name)) = (place.parent(), place.file_name()) else {
            return Err(unnamed());
        };
        refuse_occupied(target, kind, replace)?;
        fs::create_dir_all(parent).map_err(StagingError::write(target))?;
        let stem = parent.join(format!(".{}.partial", name.to_string_lossy()));
        let partial = make_fresh(&stem).map_err(StagingError::write(target))?;
        Ok(Self { target: place, partial, kind, replace })
    }

    /// Whether [`StagedFolder::new`] would accept `target`, without making anything: to refuse it
    /// before hours of work.
    ///
    /// # Errors
    /// When `target` holds something that does not make way.
    pub fn check(target: &Path, kind: Kind, replace: bool) -> Result<(), StagingError> {
        refuse_occupied(target, kind, replace)
    }

    /// Where to write.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.partial
    }

    /// Writes a file of the folder, and the folders above it.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<(), StagingError> {
        let path = self.partial.join(name);
        let shown = self.target.join(name);
        let failed = StagingError::write(&shown);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(&failed)?;
        }
        fs::write(&path, contents).map_err(&failed)
    }

    /// Moves the folder to its place.
    ///
    /// # Errors
    /// When something has come to that place meanwhile, or it cannot be written.
    pub fn commit(self) -> Result<(), StagingError> {
        refuse_occupied(&self.target, self.kind, self.replace)?;
        if self.kind.listed {
            list::write(&self.partial);
        }
        let failed = StagingError::write(&self.target);
        if !self.target.exists() {
            return fs::rename(&self.partial, &self.target).map_err(failed);
        }
        // The name is taken before the old folder goes, so that one of the two is always there.
        let mut aside = self.partial.clone().into_os_string();
        aside.push(".old");
        let aside = PathBuf::from(aside);
        fs::rename(&self.target, &aside).map_err(&failed)?;
        if let Err(error) = fs::rename(&self.partial, &self.target) {
            let _ = fs::rename(&aside, &self.target);
            return Err(failed(error));
        }
        fs::remove_dir_all(&aside).map_err(StagingError::write(&aside))
    }
}

impl Drop for StagedFolder {
    fn drop(&mut self) {
        // After a commit it is not there any more.
        let _ = fs::remove_dir_all(&self.partial);
    }
}

/// Makes a folder that did not exist.
fn make_fresh(stem: &Path) -> io::Result<PathBuf> {
    const ATTEMPTS: u32 = 100;
    let mut result = Err(io::ErrorKind::AlreadyExists.into());
    for attempt in 0..ATTEMPTS {
        let mut name = stem.as_os_str().to_owned();
        name.push(format!("-{}-{attempt}", std::process::id()));
        let path = PathBuf::from(name);
        result = fs::create_dir(&path).map(|()| path);
        if !matches!(&result, Err(error) if error.kind() == io::ErrorKind::AlreadyExists) {
            break;
        }
    }
    result
}

/// An empty folder may be written; any other only when asked, and only if it is of the same kind.
fn refuse_occupied(target: &Path, kind: Kind, replace: bool) -> Result<(), StagingError> {
    let path = || target.to_owned();
    let mut entries = match fs::read_dir(target) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(StagingError::Write { path: path(), source }),
    };
    if entries.next().is_none() {
        return Ok(());
    }
    match (replace, (kind.is)(target)) {
        (false, _) => Err(StagingError::NotEmpty { path: path() }),
        (true, false) => Err(StagingError::Foreign { path: path(), what: kind.what }),
        (true, true) if kind.listed => refuse_foreign(target),
        (true, true) => Ok(()),
    }
}

/// Every file of the folder must be on its list.
fn refuse_foreign(target: &Path) -> Result<(), StagingError> {
    const SHOWN: usize = 3;
    let path = || target.to_owned();
    let foreign = list::foreign(target).map_err(StagingError::write(target))?;
    let Some(foreign) = foreign else { return Err(StagingError::NoList { path: path() }) };
    if foreign.is_empty() {
        return Ok(());
    }
    let mut names = foreign[..foreign.len().min(SHOWN)].join(", ");
    if foreign.len() > SHOWN {
        names += &format!(" and {} more", foreign.len() - SHOWN);
    }
    Err(StagingError::Mixed { path: path(), names })
}

#[cfg(test)]
mod tests {
    use super::*;

    const KIND: Kind = Kind {
        what: "a test (marker)",
        is: |folder| folder.join("marker").is_file(),
        listed: false,
    };
    const LISTED: Kind = Kind { listed: true, ..KIND };

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
    fn what_is_dropped_leaves_nothing() {
        let dir = tempfile::tempdir().unwrap();
        let staged = StagedFolder::new(&dir.path().join("out"), KIND, false).unwrap();
        staged.write("file", b"1").unwrap();
        drop(staged);
        assert!(names(dir.path()).is_empty());
    }

    #[test]
    fn only_its_own_kind_is_replaced_and_only_when_asked() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        fs::create_dir(&target).unwrap();
        write(&target, "marker", false).unwrap();
        assert!(matches!(write(&target, "marker", false), Err(StagingError::NotEmpty { .. })));
        write(&target, "other", true).unwrap();
        assert_eq!(names(&target), ["other"]);
        let refused = write(&target, "marker", true).unwrap_err();
        assert!(refused.to_string().contains("does not hold a test (marker)"), "{refused}");
        assert_eq!((names(&target), names(dir.path())), (vec!["other".into()], vec!["out".into()]));
    }

    /// Writes a marker and a file whose name needs care.
    fn write_listed(target: &Path) -> Result<(), StagingError> {
        let staged = StagedFolder::new(target, LISTED, true)?;
        staged.write("marker", b"contents")?;
        staged.write("deep/100 %\n# é", b"contents")?;
        staged.commit()
    }

    #[test]
    fn a_listed_folder_is_replaced_only_where_all_of_it_was_written() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        write_listed(&target).unwrap();
        write_listed(&target).unwrap();
        // What is missing, and folders without a file, are no loss.
        fs::remove_dir_all(target.join("deep")).unwrap();
        fs::create_dir(target.join("empty")).unwrap();
        write_listed(&target).unwrap();
        for name in ["notes", "deep/notes", "deep/.foveate", "a", "#b"] {
            fs::write(target.join(name), "mine").unwrap();
        }
        let refused = write_listed(&target).unwrap_err().to_string();
        assert!(refused.contains("#b, a, deep/.foveate and 2 more; move them"), "{refused}");
        assert!(StagedFolder::check(&target, LISTED, true).is_err());
        assert_eq!(fs::read(target.join("deep/notes")).unwrap(), b"mine");
        assert_eq!(names(dir.path()), ["out"]);
    }

    #[test]
    fn without_its_list_a_folder_stays() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("out");
        write_listed(&target).unwrap();
        fs::remove_file(target.join(".foveate")).unwrap();
        assert!(matches!(write_listed(&target), Err(StagingError::NoList { .. })));
        assert_eq!(names(&target), ["deep", "marker"]);
    }

    #[test]
    fn places_that_cannot_be_written_are_named() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("file"), "").unwrap();
        for target in ["file", "file/out"] {
            let error = write(&dir.path().join(target), "x", false).unwrap_err().to_string();
            assert!(error.contains(&format!("{target}`")), "{error}");
        }
        assert!(matches!(write(Path::new("/"), "x", false), Err(StagingError::NoName { .. })));
    }
}
