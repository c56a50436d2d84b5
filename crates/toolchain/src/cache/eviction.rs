// SPDX-License-Identifier: MIT OR Apache-2.0
//! Removes entries if the cache is too large, and the remains of killed builds.

use std::fs::{self, DirEntry, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::entry::FolderLock;
use crate::cache_key::CacheKey;

/// The prefix of the name of a build in progress.
pub(super) const BUILDING_PREFIX: &str = ".building-";
/// The name of the folder with the logs of failed builds.
pub(super) const LOG_FOLDER: &str = "logs";
/// The prefix of the name of a folder that is being removed.
const REMOVING_PREFIX: &str = ".removing-";
/// The file that the evicting process locks, because one such process at a time is enough.
const LOCK_FILE: &str = ".evicting";
/// The age from which a build in progress is treated as the remains of a killed process.
pub(super) const STALE_AGE: Duration = Duration::from_secs(24 * 3600);

/// The folder of an entry or the log of a failed build, either of which may be removed.
struct EvictionCandidate {
    path: PathBuf,
    used: SystemTime,
    bytes: u64,
}

/// Removes the least recently used entries until `goal` bytes are left, if there are more than
/// `limit`. More bytes may be left, because entries that a process holds are not removed.
pub(super) fn evict(root: &Path, limit: u64, goal: u64) {
    let Ok(eviction_lock) = File::options().create(true).append(true).open(root.join(LOCK_FILE))
    else {
        return;
    };
    if eviction_lock.try_lock().is_err() {
        return;
    }
    let mut candidates = eviction_candidates(root);
    let mut bytes: u64 = candidates.iter().map(|candidate| candidate.bytes).sum();
    if bytes <= limit {
        return;
    }
    candidates.sort_by_key(|candidate| candidate.used);
    for candidate in candidates {
        if bytes <= goal {
            return;
        }
        if remove(root, &candidate.path) {
            bytes -= candidate.bytes;
        }
    }
}

/// Removes the remains of killed builds.
pub(super) fn remove_stale_builds(root: &Path) {
    for entry in entries(root) {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_remains = name.starts_with(BUILDING_PREFIX) || name.starts_with(REMOVING_PREFIX);
        let age = last_use(&entry).and_then(|time| SystemTime::now().duration_since(time).ok());
        if is_remains
            && age.is_some_and(|age| age > STALE_AGE)
            && FolderLock::exclusive(&entry.path()).is_some()
        {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

/// Returns the number of bytes of all files below a folder.
pub(super) fn folder_bytes(folder: &Path) -> u64 {
    let size = |entry: DirEntry| match entry.metadata() {
        Ok(meta) if meta.is_dir() => folder_bytes(&entry.path()),
        Ok(meta) => meta.len(),
        Err(_) => 0,
    };
    entries(folder).map(size).sum()
}

fn eviction_candidates(root: &Path) -> Vec<EvictionCandidate> {
    let candidate = |entry: DirEntry| {
        let (used, path) = (last_use(&entry)?, entry.path());
        let is_folder = entry.file_type().ok()?.is_dir();
        let bytes = if is_folder { folder_bytes(&path) } else { entry.metadata().ok()?.len() };
        Some(EvictionCandidate { path, used, bytes })
    };
    // Other files in the folder do not belong to the cache.
    let has_key_name = |entry: &DirEntry, suffix: &str| {
        entry
            .file_name()
            .to_str()
            .and_then(|name| name.strip_suffix(suffix))
            .is_some_and(CacheKey::is_key_name)
    };
    let built = entries(root).filter(|entry| has_key_name(entry, ""));
    let logs = entries(&root.join(LOG_FOLDER)).filter(|entry| has_key_name(entry, ".log"));
    built.chain(logs).filter_map(candidate).collect()
}

/// Moves an entry that no process holds out of its place, and then removes it.
fn remove(root: &Path, path: &Path) -> bool {
    if path.is_file() {
        return fs::remove_file(path).is_ok();
    }
    let Some(lock) = FolderLock::exclusive(path) else { return false };
    let Ok(removal_folder) = tempfile::Builder::new().prefix(REMOVING_PREFIX).tempdir_in(root)
    else {
        return false;
    };
    let is_moved = fs::rename(path, removal_folder.path()).is_ok();
    // The lock is released after the move, so that a process that waits for it sees that the entry
    // is gone.
    drop(lock);
    is_moved
}

fn entries(folder: &Path) -> impl Iterator<Item = DirEntry> + use<> {
    fs::read_dir(folder).into_iter().flatten().flatten()
}

fn last_use(entry: &DirEntry) -> Option<SystemTime> {
    entry.metadata().and_then(|meta| meta.modified()).ok()
}
