// SPDX-License-Identifier: MIT OR Apache-2.0
//! The size limit of a cache. No result depends on it, so that failures to make room are ignored.

use std::fs::{self, DirEntry, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, SystemTime};

use crate::cache_key::CacheKey;
use crate::error::ToolError;

/// The environment variable with the limit.
pub(super) const VARIABLE: &str = "FOVEATE_CACHE_SIZE";
/// The prefix of the name of a build in progress.
pub(super) const BUILDING_PREFIX: &str = ".building-";
/// The name of the folder with the logs of failed builds.
pub(super) const LOG_FOLDER: &str = "logs";
/// The age from which an entry is no longer in use.
const UNUSED_AGE: Duration = Duration::from_secs(2 * 3600);
/// The age from which a build in progress is the remains of a killed process.
pub(super) const STALE_AGE: Duration = Duration::from_secs(24 * 3600);
const MIB: u64 = 1 << 20;
const DEFAULT_LIMIT: u64 = 5 << 30;
/// The divisor of the limit that gives the slack: the number of bytes after which a process makes
/// room again, and the number of bytes that are then left free, so that a full cache is not
/// searched after every build.
const SLACK_DIVISOR: u64 = 16;

/// The largest number of bytes of a cache, or no limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SizeLimit(pub(super) Option<u64>);

impl Default for SizeLimit {
    fn default() -> Self {
        Self(Some(DEFAULT_LIMIT))
    }
}

impl SizeLimit {
    pub(super) const NONE: Self = Self(None);

    /// Parses a limit such as `500M`, `5G` or `1T`, in powers of 1,024, or `none`.
    pub(super) fn parse(text: &str) -> Result<Self, ToolError> {
        let text = text.trim();
        if text == "none" {
            return Ok(Self::NONE);
        }
        let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        let unit = match text[digits.len()..].to_ascii_uppercase().as_str() {
            "M" | "MB" | "MIB" => Some(MIB),
            "G" | "GB" | "GIB" => Some(MIB << 10),
            "T" | "TB" | "TIB" => Some(MIB << 20),
            _ => None,
        };
        let bytes = digits.parse::<u64>().ok().zip(unit);
        bytes
            .and_then(|(number, unit)| number.checked_mul(unit))
            .filter(|&bytes| bytes >= MIB)
            .map(|bytes| Self(Some(bytes)))
            .ok_or_else(|| ToolError::InvalidCacheSize { value: text.to_owned() })
    }

    /// Makes room after something of `bytes` was built, if this process has not done so since
    /// `built` bytes.
    pub(super) fn make_room(self, root: &Path, built: &AtomicU64, bytes: u64) {
        let Some(limit) = self.0 else { return };
        let slack = limit / SLACK_DIVISOR;
        let before = built.fetch_add(bytes, Ordering::Relaxed);
        if before.saturating_add(bytes) >= slack {
            built.store(0, Ordering::Relaxed);
            remove_unused(root, limit, limit - slack);
        }
    }
}

/// Sets the time of use of an entry. This fails if the folder belongs to another user, who sets the
/// time instead.
pub(super) fn mark_as_used(place: &Path) {
    if let Ok(folder) = File::open(place) {
        let _ = folder.set_modified(SystemTime::now());
    }
}

/// Returns the number of bytes of a file, or of all files below a folder. Links are not followed.
pub(super) fn bytes_of(path: &Path) -> u64 {
    match path.symlink_metadata() {
        Ok(about) if about.is_dir() => entries(path).map(|entry| bytes_of(&entry.path())).sum(),
        Ok(about) => about.len(),
        Err(_) => 0,
    }
}

/// Removes the remains of killed builds. Then removes entries and logs that are not in use, the
/// least recently used first, until `goal` bytes are left, if there are more than `limit`.
fn remove_unused(root: &Path, limit: u64, goal: u64) {
    let named = |folder: &Path, is_ours: &dyn Fn(&str) -> bool| -> Vec<(PathBuf, Duration)> {
        let ours = |entry: DirEntry| {
            let used = entry.metadata().and_then(|about| about.modified()).ok()?;
            let age = SystemTime::now().duration_since(used).unwrap_or_default();
            entry.file_name().to_str().is_some_and(is_ours).then(|| (entry.path(), age))
        };
        entries(folder).filter_map(ours).collect()
    };
    for (path, age) in named(root, &|name| name.starts_with(BUILDING_PREFIX)) {
        if age > STALE_AGE {
            let _ = fs::remove_dir_all(path);
        }
    }
    // Other files in the folder do not belong to the cache.
    let is_log = |name: &str| name.strip_suffix(".log").is_some_and(CacheKey::is_key_name);
    let mut kept = named(root, &CacheKey::is_key_name);
    kept.extend(named(&root.join(LOG_FOLDER), &is_log));
    kept.sort_by_key(|&(_, age)| std::cmp::Reverse(age));
    let sizes: Vec<u64> = kept.iter().map(|(path, _)| bytes_of(path)).collect();
    let mut bytes: u64 = sizes.iter().sum();
    if bytes <= limit {
        return;
    }
    for ((path, _), size) in kept.iter().zip(sizes).filter(|((_, age), _)| *age > UNUSED_AGE) {
        if bytes <= goal {
            return;
        }
        if remove(root, path) {
            bytes -= size;
        }
    }
}

/// Removes a log, or an entry, which is moved out of its place first, so that no part of it is left
/// there.
fn remove(root: &Path, path: &Path) -> bool {
    if path.is_file() {
        return fs::remove_file(path).is_ok();
    }
    let removed = tempfile::Builder::new().prefix(BUILDING_PREFIX).tempdir_in(root);
    removed.is_ok_and(|removed| fs::rename(path, removed.path()).is_ok())
}

fn entries(folder: &Path) -> impl Iterator<Item = DirEntry> + use<> {
    fs::read_dir(folder).into_iter().flatten().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        for (text, bytes) in
            [("1M", MIB), (" 500mb ", 500 * MIB), ("2GiB", 2 << 30), ("1T", 1 << 40)]
        {
            assert_eq!(SizeLimit::parse(text).unwrap(), SizeLimit(Some(bytes)), "{text}");
        }
        assert_eq!(SizeLimit::parse("none").unwrap(), SizeLimit::NONE);
        for text in ["", "0M", "500", "5K", "-1G", "1.5G", "G", "all", "99999999999T", "1µ"] {
            let error = SizeLimit::parse(text).unwrap_err();
            assert!(error.is_environment());
            let expected = format!("FOVEATE_CACHE_SIZE is `{text}`");
            assert!(error.to_string().contains(&expected), "{error}");
        }
    }
}
