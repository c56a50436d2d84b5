// SPDX-License-Identifier: MIT OR Apache-2.0
//! The list of the files that were written into a folder. It is a file in the folder with the hash
//! of each file, in the format of `sha256sum -c`. A file that is not on the list, or that has
//! changed, belongs to the user.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// The name of the list, which does not list itself.
pub(crate) const LIST_NAME: &str = ".foveate";
const LIST_HEADER: &[u8] = b"# Foveate wrote these files and replaces them as long as they are unchanged (sha256sum -c .foveate).\n";

/// The hash of a file as ASCII hexadecimal digits.
type FileHash = Vec<u8>;

/// The names of files, as paths relative to the folder with `/` as separator, and the hashes of
/// their allowed contents.
#[derive(Clone, Debug, Default)]
pub(crate) struct FileList(BTreeMap<Vec<u8>, Vec<FileHash>>);

/// A file below a folder. A link counts as a file and is not followed.
pub(crate) struct FolderFile {
    pub(crate) name: Vec<u8>,
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
        for line in fs::read(&path)?.split(|&byte| byte == b'\n') {
            if let Some((sum, name)) = parse_line(line) {
                list.add(name, sum);
            }
        }
        Ok(Some(list))
    }

    pub(crate) fn from_folder(folder: &Path) -> io::Result<Self> {
        let mut list = Self::default();
        for FolderFile { name, path } in files_below(folder)? {
            list.add(name, hash_of_file(&path)?);
        }
        Ok(list)
    }

    /// Lists a file with these contents, in addition to other contents that are allowed.
    pub(crate) fn add(&mut self, name: Vec<u8>, sum: FileHash) {
        let sums = self.0.entry(name).or_default();
        if !sums.contains(&sum) {
            sums.push(sum);
        }
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &[u8]> {
        self.0.keys().map(Vec::as_slice)
    }

    /// Returns whether a file is listed and has allowed contents; false if it is not a plain file.
    pub(crate) fn has_unchanged(&self, name: &[u8], path: &Path) -> bool {
        let is_file = || fs::symlink_metadata(path).is_ok_and(|about| about.is_file());
        let is_unchanged = |sums: &Vec<FileHash>| {
            is_file() && hash_of_file(path).is_ok_and(|sum| sums.contains(&sum))
        };
        self.0.get(name).is_some_and(is_unchanged)
    }

    /// Returns the description of a file that differs from the list; `None` if it does not differ.
    pub(crate) fn difference(&self, name: &[u8], path: &Path) -> Option<String> {
        if self.has_unchanged(name, path) {
            return None;
        }
        let changed = if self.0.contains_key(name) { " (changed)" } else { "" };
        Some(format!("{}{changed}", shown_name(name)))
    }

    pub(crate) fn text(&self) -> Vec<u8> {
        let mut text = LIST_HEADER.to_owned();
        for (name, sums) in &self.0 {
            for sum in sums {
                text.extend(list_line(sum, name));
            }
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
    let mut pending = vec![(folder.to_owned(), Vec::new())];
    while let Some((folder_below, prefix)) = pending.pop() {
        for entry in fs::read_dir(folder_below)? {
            let entry = entry?;
            let mut name: Vec<u8> = prefix.clone();
            name.extend(entry.file_name().as_encoded_bytes());
            if entry.file_type()?.is_dir() {
                name.push(b'/');
                pending.push((entry.path(), name));
            } else if name != LIST_NAME.as_bytes() {
                found.push(FolderFile { name, path: entry.path() });
            }
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(found)
}

/// Removes the files of a folder that match its list, the list if no other file is left, and the
/// folders that are then empty. Returns whether nothing is left.
pub(crate) fn remove_listed(folder: &Path) -> io::Result<bool> {
    let list = FileList::read(folder)?.unwrap_or_default();
    let mut all_removed = true;
    for FolderFile { name, path } in files_below(folder)? {
        if list.has_unchanged(&name, &path) {
            fs::remove_file(&path)?;
        } else {
            all_removed = false;
        }
    }
    if all_removed {
        match fs::remove_file(folder.join(LIST_NAME)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
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

/// Returns the hash of contents in memory.
pub(crate) fn hash(contents: &[u8]) -> FileHash {
    hexadecimal(&Sha256::digest(contents))
}

/// Returns the hash of the contents of a file.
pub(crate) fn hash_of_file(path: &Path) -> io::Result<FileHash> {
    let mut hasher = HashWriter(Sha256::new());
    io::copy(&mut File::open(path)?, &mut hasher)?;
    Ok(hexadecimal(&hasher.0.finalize()))
}

/// A writer that hashes its bytes.
struct HashWriter(Sha256);

impl io::Write for HashWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn hexadecimal(bytes: &[u8]) -> FileHash {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    let digit = |value: u8| DIGITS[usize::from(value)];
    bytes.iter().flat_map(|byte| [digit(byte >> 4), digit(byte & 15)]).collect()
}

/// Returns a line in the format of `sha256sum`. A backslash in front marks an escaped name.
fn list_line(sum: &[u8], name: &[u8]) -> Vec<u8> {
    let escaped: Vec<u8> = name
        .iter()
        .flat_map(|&byte| match byte {
            b'\\' => b"\\\\".to_vec(),
            b'\n' => b"\\n".to_vec(),
            b'\r' => b"\\r".to_vec(),
            _ => vec![byte],
        })
        .collect();
    let mark: &[u8] = if escaped.len() == name.len() { b"" } else { b"\\" };
    [mark, sum, b"  ", &escaped, b"\n"].concat()
}

fn parse_line(line: &[u8]) -> Option<(FileHash, Vec<u8>)> {
    const DIGITS: usize = 64;
    let (is_escaped, line) = match line.strip_prefix(b"\\") {
        Some(rest) => (true, rest),
        None => (false, line),
    };
    let (sum, rest) = line.split_at_checked(DIGITS)?;
    let name = rest.strip_prefix(b"  ").or_else(|| rest.strip_prefix(b" *"))?;
    let name = if is_escaped { unescaped(name)? } else { name.to_owned() };
    let is_sum = sum.iter().all(u8::is_ascii_hexdigit);
    (is_sum && !name.is_empty()).then(|| (sum.to_ascii_lowercase(), name))
}

fn unescaped(name: &[u8]) -> Option<Vec<u8>> {
    let (mut plain, mut bytes) = (Vec::with_capacity(name.len()), name.iter());
    while let Some(&byte) = bytes.next() {
        plain.push(match byte {
            b'\\' => match bytes.next()? {
                b'\\' => b'\\',
                b'n' => b'\n',
                b'r' => b'\r',
                _ => return None,
            },
            _ => byte,
        });
    }
    Some(plain)
}

/// Returns a name as text on one line.
fn shown_name(name: &[u8]) -> String {
    let shown = |letter: char| {
        if letter.is_control() { letter.escape_default().to_string() } else { letter.to_string() }
    };
    String::from_utf8_lossy(name).chars().map(shown).collect()
}

/// Returns the first of these names, and the number of the remaining ones.
pub(crate) fn first_names(names: &[String]) -> String {
    const SHOWN: usize = 3;
    let mut text = names[..names.len().min(SHOWN)].join(", ");
    if names.len() > SHOWN {
        text += &format!(" and {} more", names.len() - SHOWN);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_parsed_back_from_its_line() {
        let sum = hash(b"contents");
        for name in
            [&b"plain"[..], b"a/b c", b"back\\slash\nline\r", b"#hash", b"\xFF\xFE", b" two"]
        {
            let line = list_line(&sum, name);
            assert_eq!(line.iter().filter(|&&byte| byte == b'\n').count(), 1);
            assert_eq!(parse_line(&line[..line.len() - 1]), Some((sum.clone(), name.to_owned())));
        }
        for line in [&b""[..], b"# comment", b"notes.txt", b"abc  notes.txt", &sum] {
            assert_eq!(parse_line(line), None, "{}", String::from_utf8_lossy(line));
        }
    }

    #[test]
    fn sha256sum_reads_the_list() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("deep")).unwrap();
        fs::write(dir.path().join("deep/a b\\c\nd"), "contents").unwrap();
        fs::write(dir.path().join("empty"), "").unwrap();
        write_list(dir.path());
        let check = |folder: &Path| {
            std::process::Command::new("sha256sum")
                .args(["--check", "--strict", "--quiet", LIST_NAME])
                .current_dir(folder)
                .output()
        };
        let Ok(output) = check(dir.path()) else { return };
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::write(dir.path().join("empty"), "edited").unwrap();
        assert!(!check(dir.path()).unwrap().status.success());
    }
}
