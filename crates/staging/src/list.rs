// SPDX-License-Identifier: MIT OR Apache-2.0
//! The list of what was written into a folder, in the folder: what is not on it is somebody else's.

use std::collections::HashSet;
use std::fs;
use std::io;
use std::path::Path;

/// The list itself, which is not on it.
pub(crate) const NAME: &str = ".foveate";
const HEAD: &[u8] = b"# What Foveate wrote here: with --force it replaces these files, and no folder that holds others.\n";

/// Lists every file of a folder, sorted. It is a help for later: where it cannot be written there is none.
pub(crate) fn write(folder: &Path) {
    let path = folder.join(NAME);
    let listed = names(folder).and_then(|mut names| {
        names.sort();
        let mut text = HEAD.to_owned();
        for name in names {
            text.extend(escaped(&name));
            text.push(b'\n');
        }
        fs::write(&path, text)
    });
    if listed.is_err() {
        let _ = fs::remove_file(&path);
    }
}

/// The files that are not on the list, sorted; `None` where there is no list.
pub(crate) fn foreign(folder: &Path) -> io::Result<Option<Vec<String>>> {
    let text = match fs::read(folder.join(NAME)) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    let listed: HashSet<&[u8]> = text.split(|&byte| byte == b'\n').collect();
    let found =
        names(folder)?.into_iter().filter(|name| !listed.contains(escaped(name).as_slice()));
    let mut foreign: Vec<_> =
        found.map(|name| String::from_utf8_lossy(&name).into_owned()).collect();
    foreign.sort();
    Ok(Some(foreign))
}

/// Every file below, as a path from the folder with `/` between its parts. Links are not followed.
fn names(folder: &Path) -> io::Result<Vec<Vec<u8>>> {
    let mut found = Vec::new();
    let mut open = vec![(folder.to_owned(), Vec::new())];
    while let Some((next, place)) = open.pop() {
        for entry in fs::read_dir(next)? {
            let entry = entry?;
            let mut name = place.clone();
            name.extend(entry.file_name().as_encoded_bytes());
            if entry.file_type()?.is_dir() {
                name.push(b'/');
                open.push((entry.path(), name));
            } else if name != NAME.as_bytes() {
                found.push(name);
            }
        }
    }
    Ok(found)
}

/// A name in one line, and none that begins like the head.
fn escaped(name: &[u8]) -> Vec<u8> {
    let mut line = Vec::with_capacity(name.len());
    for &byte in name {
        match byte {
            b'%' | b'#' | 0..b' ' => line.extend(format!("%{byte:02X}").bytes()),
            _ => line.push(byte),
        }
    }
    line
}
