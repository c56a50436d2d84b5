// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder in which a continued command writes some files again. It overwrites only files that it
//! has listed and that have not been changed since.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::staging::file_list::{FileList, LIST_NAME, first_names, hash, hash_of_file};
use crate::staging::{StagingError, write_file};

/// A folder with the list of its files.
#[derive(Debug)]
pub struct ContinuedFolder {
    folder: PathBuf,
    list: FileList,
}

impl ContinuedFolder {
    /// Reads the list of a folder; the list is empty if there is none.
    ///
    /// # Errors
    /// Fails if the list cannot be read.
    pub fn open(folder: &Path) -> Result<Self, StagingError> {
        let list = match FileList::read(folder) {
            Err(error) if error.kind() == io::ErrorKind::NotADirectory => None,
            other => other.map_err(StagingError::unwritable(folder))?,
        };
        Ok(Self { folder: folder.to_owned(), list: list.unwrap_or_default() })
    }

    /// Lists a file with these contents, as if the command had written it.
    pub fn add_expected(&mut self, name: &str, contents: &[u8]) {
        self.list.add(name.as_bytes().to_owned(), hash(contents));
    }

    /// Refuses to continue if one of these files was not written by the command. A file may be
    /// missing.
    ///
    /// # Errors
    /// Fails if there is such a file; the error names it.
    pub fn check_files<'a>(
        &self,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Result<(), StagingError> {
        let difference = |name: &str| {
            let path = self.folder.join(name);
            fs::symlink_metadata(&path).ok()?;
            self.list.difference(name.as_bytes(), &path)
        };
        let foreign: Vec<String> = names.into_iter().filter_map(difference).collect();
        if foreign.is_empty() {
            return Ok(());
        }
        Err(StagingError::UnlistedFiles { path: self.folder.clone(), names: first_names(&foreign) })
    }

    /// Returns the names of the written files that are still there and unchanged.
    #[must_use]
    pub fn unchanged_files(&self) -> Vec<String> {
        let is_unchanged =
            |name: &&str| self.list.has_unchanged(name.as_bytes(), &self.folder.join(name));
        let names = self.list.names().filter_map(|name| std::str::from_utf8(name).ok());
        names.filter(|name| stays_in_folder(name)).filter(is_unchanged).map(str::to_owned).collect()
    }

    /// Writes all of these files in order, and removes the files that were written before and are
    /// no longer among them.
    ///
    /// # Errors
    /// Fails if one of them was not written by the command, in which case nothing is written, or if
    /// a file cannot be written.
    pub fn write(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), StagingError> {
        self.check_files(files.iter().map(|(name, _)| name.as_str()))?;
        let surplus = self.unchanged_files();
        let surplus = surplus.iter().filter(|name| files.iter().all(|(other, _)| other != *name));
        // The list has both the old and the new contents, in case the process ends before all files
        // are written.
        for (name, contents) in files {
            self.list.add(name.as_bytes().to_owned(), hash(contents));
        }
        self.write_list()?;
        for (name, contents) in files {
            let path = self.folder.join(name);
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent).map_err(StagingError::unwritable(parent))?;
            }
            write_file(&path, contents)?;
        }
        for name in surplus {
            let path = self.folder.join(name);
            fs::remove_file(&path).map_err(StagingError::unwritable(&path))?;
        }
        self.list = FileList::default();
        for (name, contents) in files {
            self.list.add(name.as_bytes().to_owned(), hash(contents));
        }
        self.write_list()
    }

    /// Lists files that another program has made for this command, with their present contents.
    ///
    /// # Errors
    /// Fails if a file cannot be read or the list cannot be written.
    pub fn list_files(
        &mut self,
        names: impl IntoIterator<Item = String>,
    ) -> Result<(), StagingError> {
        for name in names {
            let path = self.folder.join(&name);
            if fs::symlink_metadata(&path).is_ok_and(|about| about.is_file()) {
                let sum = hash_of_file(&path).map_err(StagingError::unwritable(&path))?;
                self.list.add(name.into_bytes(), sum);
            }
        }
        self.write_list()
    }

    fn write_list(&self) -> Result<(), StagingError> {
        write_file(&self.folder.join(LIST_NAME), &self.list.text())
    }
}

/// Returns whether a name in a list is a path below the folder of the list.
fn stays_in_folder(name: &str) -> bool {
    use std::path::Component;
    Path::new(name).components().all(|part| matches!(part, Component::Normal(_)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(names: &[&str], contents: &str) -> Vec<(String, Vec<u8>)> {
        names.iter().map(|name| ((*name).to_owned(), contents.into())).collect()
    }

    #[test]
    fn only_own_files_are_written_again_or_removed() {
        let dir = tempfile::tempdir().unwrap();
        let write = |names: &[&str], contents: &str| {
            ContinuedFolder::open(dir.path()).unwrap().write(&files(names, contents))
        };
        let read = |name: &str| fs::read_to_string(dir.path().join(name)).ok();
        write(&["a", "deep/1", "deep/2", "deep/3"], "old").unwrap();
        fs::write(dir.path().join("deep/3"), "mine").unwrap();
        fs::write(dir.path().join("deep/4"), "mine").unwrap();
        write(&["a", "deep/1"], "new").unwrap();
        assert_eq!(read("a").as_deref(), Some("new"));
        assert_eq!(read("deep/2"), None);
        assert_eq!((read("deep/3"), read("deep/4")), (Some("mine".into()), Some("mine".into())));
        for names in [&["a", "deep/4"][..], &["deep/3"]] {
            let refused = write(names, "newer").unwrap_err().to_string();
            assert!(refused.contains(names.last().unwrap()), "{refused}");
            assert_eq!(read("a").as_deref(), Some("new"));
        }
        fs::write(dir.path().join("a"), "edited").unwrap();
        let refused = write(&["a"], "newer").unwrap_err().to_string();
        assert!(refused.contains("a (changed)"), "{refused}");
    }

    #[test]
    fn a_forged_list_removes_nothing_elsewhere() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("out");
        fs::create_dir(&folder).unwrap();
        fs::write(dir.path().join("thesis"), "thesis").unwrap();
        let sum = String::from_utf8(hash(b"thesis")).unwrap();
        let absolute = dir.path().join("thesis").display().to_string();
        let text = format!("{sum}  ../thesis\n{sum}  {absolute}\n");
        fs::write(folder.join(LIST_NAME), text).unwrap();
        ContinuedFolder::open(&folder).unwrap().write(&files(&["a"], "new")).unwrap();
        assert_eq!(fs::read(dir.path().join("thesis")).unwrap(), b"thesis");
    }
}
