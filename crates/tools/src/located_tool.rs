// SPDX-License-Identifier: MIT OR Apache-2.0
//! A tool that was found, and the identity of its executable.

use std::path::{Path, PathBuf};

use crate::tool::ToolVersion;

/// A tool that was found and is new enough.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LocatedTool {
    /// The path of the executable.
    pub path: PathBuf,
    /// The version; `None` for a build between releases, which has none.
    pub version: Option<ToolVersion>,
    /// The line of its output that contains the version.
    pub banner: String,
    stamp: String,
}

impl LocatedTool {
    pub(crate) fn new(path: PathBuf, version: Option<ToolVersion>, banner: String) -> Self {
        let stamp = file_stamp(&path);
        Self { path, version, banner, stamp }
    }

    /// Returns whether the file is unchanged since its version was read.
    pub(crate) fn is_unchanged(&self) -> bool {
        file_stamp(&self.path) == self.stamp
    }

    /// Returns the identity of the executable: its banner, real path, size and time of change. It
    /// is part of every cache key, so that the result of one executable is never taken for that of
    /// another.
    #[must_use]
    pub fn identity(&self) -> String {
        format!("{}\n{}", self.banner, self.stamp)
    }
}

/// Returns the real path, size and time of change of a file, as far as the system reports them.
fn file_stamp(path: &Path) -> String {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let meta = std::fs::metadata(&real).ok();
    let size = meta.as_ref().map_or(0, std::fs::Metadata::len);
    let changed = meta.and_then(|meta| meta.modified().ok());
    let changed = changed.and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
    format!("{real:?} {size} {}", changed.unwrap_or_default().as_nanos())
}
