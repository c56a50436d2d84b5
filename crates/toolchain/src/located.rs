// SPDX-License-Identifier: MIT OR Apache-2.0
//! A tool that was found, and what tells its executable from any other.

use std::path::{Path, PathBuf};

use crate::tool::Version;

/// A tool that was found and is new enough.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Located {
    /// The executable.
    pub path: PathBuf,
    /// Its version; `None` for a build between releases, which has none.
    pub version: Option<Version>,
    /// The first line of what it prints about itself.
    pub banner: String,
    stamp: String,
}

impl Located {
    pub(crate) fn new(path: PathBuf, version: Option<Version>, banner: String) -> Self {
        let stamp = stamp(&path);
        Self { path, version, banner, stamp }
    }

    /// Whether the file is the one that was asked.
    pub(crate) fn is_unchanged(&self) -> bool {
        stamp(&self.path) == self.stamp
    }

    /// What tells this executable from any other: banner, real path, size and time of change. Part of
    /// every cache key, so that what one executable wrote is never taken for the work of another.
    #[must_use]
    pub fn identity(&self) -> String {
        format!("{}\n{}", self.banner, self.stamp)
    }
}

/// Real path, size and time of change of a file, as far as they can be told.
fn stamp(path: &Path) -> String {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let meta = std::fs::metadata(&real).ok();
    let size = meta.as_ref().map_or(0, std::fs::Metadata::len);
    let changed = meta.and_then(|meta| meta.modified().ok());
    let changed = changed.and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
    format!("{real:?} {size} {}", changed.unwrap_or_default().as_nanos())
}
