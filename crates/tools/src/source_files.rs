// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files that are written into a tool's folder, and excerpts of logs.

use std::fs;
use std::path::{Component, Path};

use crate::error::ToolError;
use crate::escaping::escape_hidden;

/// A source file as its name, relative to the folder of the tool, and its contents.
pub type Source = (String, String);

const EXCERPT_LINES: usize = 20;

/// Checks the name of a source. The name appears in scripts of tools, and Yosys would run a command
/// after a `;`.
///
/// # Errors
/// Fails if the name would leave its folder, is an option, or has characters with a special
/// meaning.
pub fn check_source_name(name: &str) -> Result<(), ToolError> {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "._+-/".contains(letter);
    let is_inside = |part| matches!(part, Component::Normal(_));
    let is_option = name.split('/').any(|part| part.starts_with(['-', '+']));
    let is_valid = !name.is_empty()
        && !is_option
        && name.chars().all(is_plain)
        && Path::new(name).components().all(is_inside);
    if is_valid {
        Ok(())
    } else {
        Err(ToolError::InvalidSourceName { name: escape_hidden(name).into_owned() })
    }
}

/// Writes one file and the folders above it.
pub(crate) fn write_file(dir: &Path, name: &str, contents: &[u8]) -> Result<(), ToolError> {
    check_source_name(name)?;
    let path = dir.join(name);
    if let Some(parent) = path.parent() {
        fs::create_dir_all(parent).map_err(ToolError::io("create", parent))?;
    }
    fs::write(&path, contents).map_err(ToolError::io("write", &path))
}

/// Writes all sources below `dir`.
pub(crate) fn write_sources(dir: &Path, sources: &[Source]) -> Result<(), ToolError> {
    sources.iter().try_for_each(|(name, contents)| write_file(dir, name, contents.as_bytes()))
}

/// Returns the last lines of a log, preceded by the first error if that is further up.
pub(crate) fn log_excerpt(log: &str) -> String {
    let lines: Vec<&str> = log.lines().collect();
    let start = lines.len().saturating_sub(EXCERPT_LINES);
    let tail = lines[start..].join("\n");
    let is_error = |line: &&&str| line.to_ascii_lowercase().contains("error");
    match lines[..start].iter().find(is_error) {
        Some(first) => format!("{first}\n...\n{tail}"),
        None => tail,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_inside() {
        let dir = tempfile::tempdir().unwrap();
        for name in [
            "../x.v",
            "/tmp/x.v",
            "",
            "a/../../x.v",
            "a b.v",
            "a;b.v",
            "a\n!b.v",
            "a$b.v",
            "it's.v",
            "-f.v",
            "rtl/-f.v",
            "+x.v",
            "\u{e4}.v",
            "\u{1b}.v",
        ] {
            let error = write_file(dir.path(), name, b"").unwrap_err();
            assert!(matches!(error, ToolError::InvalidSourceName { .. }), "{name}");
        }
        write_file(dir.path(), "rtl/x.v", b"x").unwrap();
        assert!(dir.path().join("rtl/x.v").is_file());
    }

    #[test]
    fn excerpts_keep_the_first_error() {
        let mut lines = vec!["noise".to_owned(), "x.v:1: error: here".to_owned()];
        lines.extend((0..40).map(|i| format!("line {i}")));
        let excerpt = log_excerpt(&lines.join("\n"));
        assert!(excerpt.starts_with("x.v:1: error: here\n...\nline 20\n"), "{excerpt}");
        assert!(excerpt.ends_with("line 39"), "{excerpt}");
        assert_eq!(log_excerpt("a\nb\n"), "a\nb");
    }
}
