// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder of finished builds, each under the hash of all its inputs.
//!
//! * An entry is built in a temporary folder next to its final place and renamed when complete, so
//!   an entry is either complete or absent. Two processes may build the same entry at once; the
//!   first to finish wins. An entry that is gone is built again.
//! * Programs are run from the folder, so other users must not be able to write to it.
//! * The folder has a size limit. The entries that were used least recently are removed first, and
//!   those of the last hours never, because a process may still need them.

mod folder_trust;
mod size_limit;
#[cfg(test)]
mod tests;

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicU64;

use tempfile::TempDir;

use self::size_limit::{BUILDING_PREFIX, LOG_FOLDER, SizeLimit};
use crate::cache_key::CacheKey;
use crate::error::ToolError;
use crate::host::{Host, SystemHost};
use crate::staging::ScratchFolder;

/// The number of attempts to move a build to its place while other processes add and remove
/// entries.
const PUBLISH_ATTEMPTS: u32 = 3;

/// A build cache. Clones share the folder.
#[derive(Debug, Clone)]
pub struct Cache {
    root: PathBuf,
    limit: SizeLimit,
    /// The number of bytes built since this process last made room; the largest number before it
    /// has done so for the first time.
    built_bytes: Arc<AtomicU64>,
    scratch: Option<Arc<ScratchFolder>>,
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
            variable(size_limit::VARIABLE).map(|value| SizeLimit::parse(&value.to_string_lossy()));
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
        let built_bytes = Arc::new(AtomicU64::new(u64::MAX));
        Ok(Self { root, limit: SizeLimit::default(), built_bytes, scratch: None })
    }

    /// Makes a cache that is deleted together with its last clone, with all entries.
    ///
    /// # Errors
    /// Fails if the temporary folder cannot be created.
    pub fn temporary() -> Result<Self, ToolError> {
        let parent = std::env::temp_dir();
        let dir =
            ScratchFolder::new().map_err(ToolError::temporary("create a folder in", &parent))?;
        let cache = Self::in_folder(dir.path())?;
        Ok(Self { limit: SizeLimit::NONE, scratch: Some(Arc::new(dir)), ..cache })
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

    /// Returns the path of `artifact` in the entry of `key`, and builds the entry first if it is
    /// not there. `build` fills an empty folder, whose content becomes the entry. If `build` fails,
    /// nothing remains but the log of the failure, which a throw-away cache does not keep either.
    ///
    /// # Errors
    /// Fails if `build` fails, if the folder cannot be written, or if another user can write to it.
    pub fn get_or_build(
        &self,
        key: &CacheKey,
        artifact: &str,
        build: impl FnOnce(&Path) -> Result<(), ToolError>,
    ) -> Result<PathBuf, ToolError> {
        let root = folder_trust::open_root(&self.root)?;
        let place = root.join(key.as_str());
        let path = place.join(artifact);
        if is_usable(&place, artifact) {
            size_limit::mark_as_used(&place);
            return Ok(path);
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(BUILDING_PREFIX);
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let dir =
            builder.tempdir_in(&root).map_err(ToolError::cache("create a folder in", &root))?;
        build(dir.path()).map_err(|error| self.keep_log(key, error))?;
        let bytes = size_limit::bytes_of(dir.path());
        publish(dir, &place, artifact)?;
        self.limit.make_room(&root, &self.built_bytes, bytes);
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

/// Returns whether an entry is complete, and only this user and root could change it.
fn is_usable(place: &Path, artifact: &str) -> bool {
    place.join(artifact).exists() && folder_trust::is_entry(place, artifact)
}

/// Moves a finished build to its place, unless another process has already built the entry.
fn publish(dir: TempDir, place: &Path, artifact: &str) -> Result<(), ToolError> {
    let mut attempts = PUBLISH_ATTEMPTS;
    loop {
        let Err(error) = fs::rename(dir.path(), place) else {
            let _moved = dir.keep();
            return Ok(());
        };
        if is_usable(place, artifact) {
            return Ok(());
        }
        attempts -= 1;
        if attempts == 0 {
            return Err(ToolError::io("write", place)(error));
        }
        // The entry is damaged because a part of it was deleted, by hand or by a cleaner of old
        // files, or another user could change it.
        if let Err(error) = fs::remove_dir_all(place)
            && error.kind() != std::io::ErrorKind::NotFound
        {
            return Err(ToolError::io("remove the damaged", place)(error));
        }
    }
}
