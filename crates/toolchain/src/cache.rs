// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder of finished builds, each under the hash of all its inputs.
//!
//! * An entry is built in a temporary folder next to its final place and renamed when complete, so
//!   an entry is either complete or absent. Two processes may build the same entry at once; the
//!   first to finish wins.
//! * Programs are run from the folder, so other users must not be able to write to it.
//! * The folder has a size limit. The entry that was used least recently is removed first; an entry
//!   that a process holds is not removed.

mod entry;
mod eviction;
mod folder_trust;
mod limit;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use foveate_staging::ScratchFolder;
use tempfile::TempDir;

pub use self::entry::CacheEntry;
use self::entry::FolderLock;
use self::eviction::{BUILDING_PREFIX, LOG_FOLDER};
use self::limit::CacheLimit;
use crate::cache_key::CacheKey;
use crate::error::ToolError;
use crate::host::{Host, SystemHost};

/// The number of attempts to move a build to its place while other processes add and remove
/// entries.
const PUBLISH_ATTEMPTS: u32 = 3;

/// A build cache. Clones share the folder.
#[derive(Debug, Clone)]
pub struct Cache {
    root: PathBuf,
    limit: CacheLimit,
    state: Arc<SharedCacheState>,
    scratch: Option<Arc<ScratchFolder>>,
}

/// The state that the clones of a cache share.
#[derive(Debug, Default)]
struct SharedCacheState {
    stale_builds_removed: OnceLock<()>,
    /// The number of bytes built since the folder was last checked against its limit; unset before
    /// the first check.
    built_bytes: OnceLock<AtomicU64>,
    kept_entries: Mutex<HashMap<PathBuf, CacheEntry>>,
}

impl Cache {
    /// Returns the cache of the user: `FOVEATE_CACHE`, else `foveate` in `XDG_CACHE_HOME` or
    /// `~/.cache`, with the size of `FOVEATE_CACHE_SIZE`. `FOVEATE_CACHE=off` gives a throw-away
    /// cache.
    ///
    /// # Errors
    /// Fails if none of the variables is set, if the size is invalid, or if a throw-away folder
    /// cannot be created.
    pub fn from_env() -> Result<Self, ToolError> {
        Self::from_host(&SystemHost)
    }

    fn from_host(host: &dyn Host) -> Result<Self, ToolError> {
        let variable = |name| host.variable(name).filter(|value: &OsString| !value.is_empty());
        let limit =
            variable(limit::VARIABLE).map(|value| CacheLimit::parse(&value.to_string_lossy()));
        let limit = limit.transpose()?.unwrap_or_default();
        let root = match variable("FOVEATE_CACHE") {
            Some(value) if value == "off" => return Self::temporary(),
            Some(value) => PathBuf::from(value),
            None => variable("XDG_CACHE_HOME")
                .map(PathBuf::from)
                .or_else(|| variable("HOME").map(|home| Path::new(&home).join(".cache")))
                .ok_or(ToolError::NoCacheFolder)?
                .join("foveate"),
        };
        Ok(Self { limit, ..Self::in_folder(&root)? })
    }

    /// Makes a cache of the default size in this folder, which is created when something is built.
    ///
    /// # Errors
    /// Fails if the path cannot be made absolute.
    pub fn in_folder(root: &Path) -> Result<Self, ToolError> {
        let root = std::path::absolute(root).map_err(ToolError::io("use", root))?;
        Ok(Self { root, limit: CacheLimit::default(), state: Arc::default(), scratch: None })
    }

    /// Makes a cache that is deleted together with its last clone, with all entries.
    ///
    /// # Errors
    /// Fails if the temporary folder cannot be created.
    pub fn temporary() -> Result<Self, ToolError> {
        let parent = std::env::temp_dir();
        let dir =
            ScratchFolder::new().map_err(ToolError::temporary("create a folder in", &parent))?;
        let root = dir.path().to_owned();
        let scratch = Some(Arc::new(dir));
        Ok(Self { root, limit: CacheLimit::NONE, state: Arc::default(), scratch })
    }

    /// Returns the folder of the cache.
    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Returns whether `artifact` is in the entry of `key`.
    #[must_use]
    pub fn contains(&self, key: &CacheKey, artifact: &str) -> bool {
        self.root.join(key.as_str()).join(artifact).exists()
    }

    /// Returns `artifact` in the entry of `key`, and builds the entry first if it is not there. The
    /// entry stays as long as the result lives. `build` fills an empty folder, whose content
    /// becomes the entry. If `build` fails, nothing remains but the log of the failure, which a
    /// throw-away cache does not keep either.
    ///
    /// # Errors
    /// Fails if `build` fails, if the folder cannot be written, or if another user can write to it.
    pub fn get_or_build(
        &self,
        key: &CacheKey,
        artifact: &str,
        build: impl FnOnce(&Path) -> Result<(), ToolError>,
    ) -> Result<CacheEntry, ToolError> {
        let root = folder_trust::open_root(&self.root)?;
        let place = root.join(key.as_str());
        if let Some(entry) = CacheEntry::open_entry(&place, artifact) {
            return Ok(entry);
        }
        self.state.stale_builds_removed.get_or_init(|| eviction::remove_stale_builds(&root));
        let mut builder = tempfile::Builder::new();
        builder.prefix(BUILDING_PREFIX);
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let dir =
            builder.tempdir_in(&root).map_err(ToolError::cache("create a folder in", &root))?;
        let missing_error =
            || ToolError::cache("use", dir.path())(std::io::ErrorKind::NotFound.into());
        let lock = FolderLock::shared(dir.path()).ok_or_else(missing_error)?;
        build(dir.path()).map_err(|error| self.keep_log(key, error))?;
        let bytes = eviction::folder_bytes(dir.path());
        let entry = publish(dir, lock, &place, artifact)?;
        self.limit.enforce(&root, &self.state.built_bytes, bytes);
        Ok(entry)
    }

    /// Returns an artifact like [`Cache::get_or_build`], and keeps its entry as long as the cache
    /// and its clones live.
    ///
    /// # Errors
    /// Fails like [`Cache::get_or_build`].
    pub fn keep_or_build(
        &self,
        key: &CacheKey,
        artifact: &str,
        build: impl FnOnce(&Path) -> Result<(), ToolError>,
    ) -> Result<PathBuf, ToolError> {
        let entry = self.get_or_build(key, artifact, build)?;
        let path = entry.path().to_owned();
        let mut kept_entries =
            self.state.kept_entries.lock().unwrap_or_else(PoisonError::into_inner);
        kept_entries.entry(path.clone()).or_insert(entry);
        Ok(path)
    }

    /// Writes the log of a failed build next to the entries, and adds its path to the error.
    fn keep_log(&self, key: &CacheKey, error: ToolError) -> ToolError {
        let ToolError::Failed { command, status, tail, log: None, full } = error else {
            return error;
        };
        let path = self.root.join(LOG_FOLDER).join(format!("{key}.log"));
        let text = format!("$ {command}\n{full}\n{status}\n");
        let written = self.scratch.is_none()
            && fs::create_dir_all(self.root.join(LOG_FOLDER)).is_ok()
            && fs::write(&path, text).is_ok();
        ToolError::Failed { command, status, tail, log: written.then_some(path), full }
    }
}

/// Moves a finished build to its place, unless another process has already built the entry.
fn publish(
    dir: TempDir,
    lock: FolderLock,
    place: &Path,
    artifact: &str,
) -> Result<CacheEntry, ToolError> {
    let mut attempts = PUBLISH_ATTEMPTS;
    loop {
        if place.exists()
            && !(place.join(artifact).exists() && folder_trust::is_entry(place, artifact))
        {
            // The entry is damaged because a part of it was deleted, by hand or by a cleaner of old
            // files, or another user could change it.
            fs::remove_dir_all(place).map_err(ToolError::io("remove the damaged", place))?;
        }
        let error = match fs::rename(dir.path(), place) {
            Ok(()) => {
                let _moved = dir.keep();
                return Ok(CacheEntry::new(place.join(artifact), lock));
            }
            Err(error) => error,
        };
        if let Some(entry) = CacheEntry::open_entry(place, artifact) {
            return Ok(entry);
        }
        attempts -= 1;
        if attempts == 0 {
            return Err(ToolError::io("write", place)(error));
        }
    }
}
