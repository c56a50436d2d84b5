// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder in which a continued command writes some files again. It overwrites only files that it
//! has listed and that have not been changed since.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::cache_key::sha256_hex;
use crate::staging::file_list::{FileList, FolderFile, LIST_NAME, files_below, hash_of_file};
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
        self.list.add(name, sha256_hex(contents));
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
        let file = |name: &str| FolderFile { name: name.to_owned(), path: self.folder.join(name) };
        let files = names.into_iter().map(file);
        let files: Vec<_> = files.filter(|file| fs::symlink_metadata(&file.path).is_ok()).collect();
        self.list.differences(&files).map_or(Ok(()), |names| {
            Err(StagingError::UnlistedFiles { path: self.folder.clone(), names })
        })
    }

    /// Writes all of these files in order, and removes the files that were written before and are
    /// no longer among them.
    ///
    /// # Errors
    /// Fails if one of them was not written by the command, in which case nothing is written, or if
    /// a file cannot be written.
    pub fn write(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), StagingError> {
        self.check_files(files.iter().map(|(name, _)| name.as_str()))?;
        let mut surplus =
            files_below(&self.folder).map_err(StagingError::unwritable(&self.folder))?;
        surplus.retain(|file| {
            files.iter().all(|(name, _)| *name != file.name) && self.list.has_unchanged(file)
        });
        // The list has both the old and the new contents, in case the process ends before all files
        // are written.
        files.iter().for_each(|(name, contents)| self.add_expected(name, contents));
        self.write_list()?;
        for (name, contents) in files {
            let path = self.folder.join(name);
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent).map_err(StagingError::unwritable(parent))?;
            }
            write_file(&path, contents)?;
        }
        for FolderFile { path, .. } in surplus {
            fs::remove_file(&path).map_err(StagingError::unwritable(&path))?;
        }
        self.list = FileList::default();
        files.iter().for_each(|(name, contents)| self.add_expected(name, contents));
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
                self.list.add(&name, sum);
            }
        }
        self.write_list()
    }

    fn write_list(&self) -> Result<(), StagingError> {
        write_file(&self.folder.join(LIST_NAME), self.list.text().as_bytes())
    }
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
        let sum = sha256_hex("thesis");
        let absolute = dir.path().join("thesis").display().to_string();
        let text = format!("{sum}  ../thesis\n{sum}  {absolute}\n");
        fs::write(folder.join(LIST_NAME), text).unwrap();
        ContinuedFolder::open(&folder).unwrap().write(&files(&["a"], "new")).unwrap();
        assert_eq!(fs::read(dir.path().join("thesis")).unwrap(), b"thesis");
    }
}
