// SPDX-License-Identifier: MIT OR Apache-2.0
//! What goes when the cache is too large, or when nobody needs it any more.

use std::fs::{self, DirEntry, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::entry::Hold;
use crate::key::Key;

/// Names of what lies beside the entries: a build under way, the logs of those that failed, and what is being
/// removed.
pub(super) const BUILDING: &str = ".building-";
pub(super) const LOGS: &str = "logs";
const REMOVING: &str = ".removing-";
/// Held by the process that looks through the cache: one is enough.
const GATE: &str = ".evicting";
/// What is older is no build under way but the rest of one that was killed.
pub(super) const STALE: Duration = Duration::from_secs(24 * 3600);

/// What may go: the folder of an entry, or the log of a failed build.
struct Candidate {
    path: PathBuf,
    used: SystemTime,
    bytes: u64,
}

/// Removes what was used least recently until `goal` bytes are left, if there are more than `limit`. What
/// a process holds stays, so that more may be left.
pub(super) fn evict(root: &Path, limit: u64, goal: u64) {
    let Ok(gate) = File::options().create(true).append(true).open(root.join(GATE)) else { return };
    if gate.try_lock().is_err() {
        return;
    }
    let mut candidates = candidates(root);
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

/// Removes what killed builds have left.
pub(super) fn sweep(root: &Path) {
    for entry in entries(root) {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let rest = name.starts_with(BUILDING) || name.starts_with(REMOVING);
        let age = used(&entry).and_then(|time| SystemTime::now().duration_since(time).ok());
        if rest && age.is_some_and(|age| age > STALE) && Hold::exclusive(&entry.path()).is_some() {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

/// Bytes of all files below.
pub(super) fn size(folder: &Path) -> u64 {
    let size = |entry: DirEntry| match entry.metadata() {
        Ok(meta) if meta.is_dir() => size(&entry.path()),
        Ok(meta) => meta.len(),
        Err(_) => 0,
    };
    entries(folder).map(size).sum()
}

fn candidates(root: &Path) -> Vec<Candidate> {
    let candidate = |entry: DirEntry| {
        let (used, path) = (used(&entry)?, entry.path());
        let folder = entry.file_type().ok()?.is_dir();
        let bytes = if folder { size(&path) } else { entry.metadata().ok()?.len() };
        Some(Candidate { path, used, bytes })
    };
    // Whatever else lies there is not ours.
    let named = |entry: &DirEntry, end: &str| {
        entry.file_name().to_str().and_then(|name| name.strip_suffix(end)).is_some_and(Key::is_name)
    };
    let built = entries(root).filter(|entry| named(entry, ""));
    let logs = entries(&root.join(LOGS)).filter(|entry| named(entry, ".log"));
    built.chain(logs).filter_map(candidate).collect()
}

/// Takes an entry that nobody holds out of its place, and then removes it.
fn remove(root: &Path, path: &Path) -> bool {
    if path.is_file() {
        return fs::remove_file(path).is_ok();
    }
    let Some(hold) = Hold::exclusive(path) else { return false };
    let Ok(aside) = tempfile::Builder::new().prefix(REMOVING).tempdir_in(root) else {
        return false;
    };
    let moved = fs::rename(path, aside.path()).is_ok();
    // Whoever waits for it shall see that it is gone.
    drop(hold);
    moved
}

fn entries(folder: &Path) -> impl Iterator<Item = DirEntry> + use<> {
    fs::read_dir(folder).into_iter().flatten().flatten()
}

fn used(entry: &DirEntry) -> Option<SystemTime> {
    entry.metadata().and_then(|meta| meta.modified()).ok()
}
