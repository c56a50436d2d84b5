// SPDX-License-Identifier: MIT OR Apache-2.0
//! The list of the files that were written into a folder. It is a file in the folder with the hash
//! of each file, in the format of `sha256sum -c`. A file that is not on the list, or that has
//! changed, belongs to the user. The paths in a list are never opened: files are found in the
//! folder and looked up in the list.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufRead as _, BufReader};
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

use crate::cache_key::hex;

/// The name of the list, which does not list itself.
pub(crate) const LIST_NAME: &str = ".foveate";
const LIST_HEADER: &str = "# Foveate wrote these files and replaces them as long as they are unchanged (sha256sum -c .foveate).\n";

/// The names of files as `sha256sum` escapes them, as paths relative to the folder with `/` as
/// separator, and the hashes of their allowed contents.
#[derive(Clone, Debug, Default)]
pub(crate) struct FileList(BTreeMap<String, Vec<String>>);

/// A file below a folder. A link counts as a file and is not followed.
pub(crate) struct FolderFile {
    pub(crate) name: String,
    pub(crate) path: PathBuf,
}

impl FileList {
    /// Returns the list of a folder; `None` if there is none. Invalid lines are ignored, so their
    /// files are not listed.
    pub(crate) fn read(folder: &Path) -> io::Result<Option<Self>> {
        let path = folder.join(LIST_NAME);
        match fs::symlink_metadata(&path) {
            Ok(about) if about.is_file() => {}
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => return Ok(None),
        }
        let mut list = Self::default();
        for line in String::from_utf8_lossy(&fs::read(&path)?).lines() {
            // Two spaces, or a space and a star, follow the hash. A backslash before it says that
            // the name is escaped.
            if let Some((sum, name)) = line.split_once(' ')
                && let Some(name) = name.strip_prefix([' ', '*'])
            {
                list.insert(name.to_owned(), sum.trim_start_matches('\\').to_owned());
            }
        }
        Ok(Some(list))
    }

    pub(crate) fn from_folder(folder: &Path) -> io::Result<Self> {
        let mut list = Self::default();
        for FolderFile { name, path } in files_below(folder)? {
            list.add(&name, hash_of_file(&path)?);
        }
        Ok(list)
    }

    /// Lists a file with these contents, in addition to other contents that are allowed.
    pub(crate) fn add(&mut self, name: &str, sum: String) {
        self.insert(escaped(name), sum);
    }

    fn insert(&mut self, escaped_name: String, sum: String) {
        let sums = self.0.entry(escaped_name).or_default();
        if !sums.contains(&sum) {
            sums.push(sum);
        }
    }

    /// Returns whether a file is listed and has allowed contents; false if it is not a plain file.
    pub(crate) fn has_unchanged(&self, FolderFile { name, path }: &FolderFile) -> bool {
        let is_file = || fs::symlink_metadata(path).is_ok_and(|about| about.is_file());
        self.0.get(&escaped(name)).is_some_and(|sums| {
            is_file() && hash_of_file(path).is_ok_and(|sum| sums.contains(&sum))
        })
    }

    /// Returns the first of the files that differ from the list, and the number of the remaining
    /// ones; `None` if all are as they were written.
    pub(crate) fn differences(&self, files: &[FolderFile]) -> Option<String> {
        const SHOWN: usize = 3;
        let differ = files.iter().filter(|file| !self.has_unchanged(file));
        let names = differ.map(|FolderFile { name, .. }| {
            let changed = if self.0.contains_key(&escaped(name)) { " (changed)" } else { "" };
            let shown = |letter: char| match letter.is_control() {
                true => letter.escape_default().to_string(),
                false => letter.to_string(),
            };
            name.chars().map(shown).collect::<String>() + changed
        });
        let names: Vec<String> = names.collect();
        match names.len() {
            0 => None,
            1..=SHOWN => Some(names.join(", ")),
            all => Some(format!("{} and {} more", names[..SHOWN].join(", "), all - SHOWN)),
        }
    }

    pub(crate) fn text(&self) -> String {
        let mut text = LIST_HEADER.to_owned();
        for (name, sums) in &self.0 {
            let mark = if name.contains('\\') { "\\" } else { "" };
            sums.iter().for_each(|sum| text += &format!("{mark}{sum}  {name}\n"));
        }
        text
    }
}

/// Writes the list of a folder. If it cannot be written, the folder has no list.
pub(crate) fn write_list(folder: &Path) {
    let path = folder.join(LIST_NAME);
    let written = FileList::from_folder(folder).and_then(|list| fs::write(&path, list.text()));
    if written.is_err() {
        let _ = fs::remove_file(&path);
    }
}

/// Returns every file below a folder except the list itself, sorted by name.
pub(crate) fn files_below(folder: &Path) -> io::Result<Vec<FolderFile>> {
    let mut found = Vec::new();
    let mut pending = vec![(folder.to_owned(), String::new())];
    while let Some((folder_below, prefix)) = pending.pop() {
        for entry in fs::read_dir(folder_below)? {
            let entry = entry?;
            let (name, path) =
                (format!("{prefix}{}", entry.file_name().to_string_lossy()), entry.path());
            if entry.file_type()?.is_dir() {
                pending.push((path, name + "/"));
            } else if name != LIST_NAME {
                found.push(FolderFile { name, path });
            }
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(found)
}

/// Removes the files of a folder that match its list, the list if no other file is left, and the
/// folders that are then empty. Returns whether nothing is left.
pub(crate) fn remove_listed(folder: &Path) -> io::Result<bool> {
    if !folder.is_dir() {
        return Ok(true);
    }
    let list = FileList::read(folder)?.unwrap_or_default();
    let files = files_below(folder)?.into_iter();
    let (own, others): (Vec<_>, Vec<_>) = files.partition(|file| list.has_unchanged(file));
    own.iter().try_for_each(|file| fs::remove_file(&file.path))?;
    if others.is_empty() {
        // If it stays, the folder is not empty.
        let _ = fs::remove_file(folder.join(LIST_NAME));
    }
    Ok(remove_empty(folder))
}

/// Removes a folder and its subfolders. A folder that holds a file stays, even if the file was
/// added a moment ago.
fn remove_empty(folder: &Path) -> bool {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir())) {
        remove_empty(&entry.path());
    }
    fs::remove_dir(folder).is_ok()
}

/// Returns the hash of the contents of a file.
pub(crate) fn hash_of_file(path: &Path) -> io::Result<String> {
    let (mut file, mut hasher) = (BufReader::new(File::open(path)?), Sha256::new());
    loop {
        let bytes = file.fill_buf()?;
        let length = bytes.len();
        if length == 0 {
            return Ok(hex(&hasher.finalize()));
        }
        hasher.update(bytes);
        file.consume(length);
    }
}

/// Returns a name on one line, as `sha256sum` writes it.
fn escaped(name: &str) -> String {
    name.replace('\\', "\\\\").replace('\n', "\\n").replace('\r', "\\r")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Files with all kinds of names are found in a list that is read again, and `sha256sum` reads
    /// the list, too.
    #[test]
    fn a_list_is_read_as_it_was_written() {
        let dir = tempfile::tempdir().unwrap();
        let names = [" two", "#hash", "\\n", "a  b", "back\\slash\nline\r", "deep/a b\\c\nd"];
        fs::create_dir(dir.path().join("deep")).unwrap();
        names.iter().for_each(|name| fs::write(dir.path().join(name), name).unwrap());
        write_list(dir.path());
        let list = || FileList::read(dir.path()).unwrap().unwrap();
        let files = files_below(dir.path()).unwrap();
        assert_eq!(files.iter().map(|file| file.name.as_str()).collect::<Vec<_>>(), names);
        assert_eq!(list().differences(&files), None);
        let check = || {
            let check = ["--check", "--strict", "--quiet", LIST_NAME];
            let mut sha256sum = std::process::Command::new("sha256sum");
            sha256sum.args(check).current_dir(dir.path()).output().ok()
        };
        assert!(check().is_none_or(|output| output.status.success()));
        fs::write(dir.path().join("#hash"), "edited").unwrap();
        assert!(check().is_none_or(|output| !output.status.success()));
        assert_eq!(list().differences(&files).as_deref(), Some("#hash (changed)"));
        for text in ["", "# comment", "notes.txt", "abc  notes.txt"] {
            fs::write(dir.path().join(LIST_NAME), text).unwrap();
            assert_eq!(list().differences(&files[..1]).as_deref(), Some(" two"), "{text}");
        }
    }
}
