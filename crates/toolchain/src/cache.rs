// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder of finished builds, each under the hash of all that went into it.
//!
//! An entry is built in a temporary folder beside its place and renamed when complete, so that it is
//! whole or absent: two processes may build the same entry at once, and the first to finish wins.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, SystemTime};

use tempfile::TempDir;

use crate::error::ToolError;
use crate::host::{Host, SystemHost};
use crate::key::Key;

const BUILDING: &str = ".building-";
/// What is older is no build under way but the rest of one that was killed.
const STALE: Duration = Duration::from_secs(24 * 3600);

/// A build cache. Clones share the folder.
#[derive(Debug, Clone)]
pub struct Cache {
    root: PathBuf,
    swept: Arc<OnceLock<()>>,
    scratch: Option<Arc<TempDir>>,
}

impl Cache {
    /// The cache of the user: `FOVEATE_CACHE`, else `foveate` in `XDG_CACHE_HOME` or `~/.cache`.
    /// `FOVEATE_CACHE=off` gives a throw-away cache.
    ///
    /// # Errors
    /// When none of the variables is set, or a throw-away folder cannot be created.
    pub fn from_env() -> Result<Self, ToolError> {
        Self::from_host(&SystemHost)
    }

    fn from_host(host: &dyn Host) -> Result<Self, ToolError> {
        let variable = |name| host.variable(name).filter(|value: &OsString| !value.is_empty());
        let root = match variable("FOVEATE_CACHE") {
            Some(value) if value == "off" => return Self::throw_away(),
            Some(value) => PathBuf::from(value),
            None => variable("XDG_CACHE_HOME")
                .map(PathBuf::from)
                .or_else(|| variable("HOME").map(|home| Path::new(&home).join(".cache")))
                .ok_or(ToolError::NoCache)?
                .join("foveate"),
        };
        Self::at(&root)
    }

    /// A cache in this folder, which is created when something is built.
    ///
    /// # Errors
    /// When the path cannot be made absolute.
    pub fn at(root: &Path) -> Result<Self, ToolError> {
        let root = std::path::absolute(root).map_err(ToolError::io("use", root))?;
        Ok(Self { root, swept: Arc::default(), scratch: None })
    }

    /// A cache that is deleted with its last clone, and all that was built in it.
    ///
    /// # Errors
    /// When the temporary folder cannot be created.
    pub fn throw_away() -> Result<Self, ToolError> {
        let parent = std::env::temp_dir();
        let dir = tempfile::Builder::new()
            .prefix("foveate-")
            .tempdir_in(&parent)
            .map_err(ToolError::temporary("create a folder in", &parent))?;
        let root = dir.path().to_owned();
        Ok(Self { root, swept: Arc::default(), scratch: Some(Arc::new(dir)) })
    }

    /// The folder of the cache.
    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Whether `artifact` is in the entry of `key`.
    #[must_use]
    pub fn holds(&self, key: &Key, artifact: &str) -> bool {
        self.root.join(key.as_str()).join(artifact).exists()
    }

    /// The path of `artifact` in the entry of `key`, after building it if need be. `build` fills an
    /// empty folder; what it leaves there becomes the entry. If it fails, nothing remains but the log
    /// of the failure, in a cache that lasts.
    ///
    /// # Errors
    /// Those of `build`, or that the folder cannot be written.
    pub fn get_or_build(
        &self,
        key: &Key,
        artifact: &str,
        build: impl FnOnce(&Path) -> Result<(), ToolError>,
    ) -> Result<PathBuf, ToolError> {
        let entry = self.root.join(key.as_str());
        let wanted = entry.join(artifact);
        if wanted.exists() {
            return Ok(wanted);
        }
        fs::create_dir_all(&self.root).map_err(ToolError::cache("create", &self.root))?;
        self.sweep();
        let dir = tempfile::Builder::new()
            .prefix(BUILDING)
            .tempdir_in(&self.root)
            .map_err(ToolError::cache("create a folder in", &self.root))?;
        build(dir.path()).map_err(|error| self.keep_log(key, error))?;
        publish(dir, &entry, &wanted)?;
        Ok(wanted)
    }

    /// Removes what killed builds have left, once. Nothing depends on it, so that a failure is none.
    fn sweep(&self) {
        self.swept.get_or_init(|| {
            for entry in fs::read_dir(&self.root).into_iter().flatten().flatten() {
                let named = entry.file_name().to_string_lossy().starts_with(BUILDING);
                let changed = entry.metadata().and_then(|meta| meta.modified());
                let age = changed.ok().and_then(|time| SystemTime::now().duration_since(time).ok());
                if named && age.is_some_and(|age| age > STALE) {
                    let _ = fs::remove_dir_all(entry.path());
                }
            }
        });
    }

    /// Writes the log of a failed build beside the entries and names it in the error.
    fn keep_log(&self, key: &Key, error: ToolError) -> ToolError {
        let ToolError::Failed { command, status, tail, log: None, full } = error else {
            return error;
        };
        let path = self.root.join("logs").join(format!("{key}.log"));
        let text = format!("$ {command}\n{full}\n{status}\n");
        let written = self.scratch.is_none()
            && fs::create_dir_all(self.root.join("logs")).is_ok()
            && fs::write(&path, text).is_ok();
        ToolError::Failed { command, status, tail, log: written.then_some(path), full }
    }
}

/// Moves a finished build to its place, unless another has got there first.
fn publish(dir: TempDir, entry: &Path, wanted: &Path) -> Result<(), ToolError> {
    if entry.exists() && !wanted.exists() {
        // A damaged entry: half of it was deleted by hand or by a cleaner of old files.
        fs::remove_dir_all(entry).map_err(ToolError::io("remove the damaged", entry))?;
    }
    match fs::rename(dir.path(), entry) {
        Ok(()) => {
            let _moved = dir.keep();
            Ok(())
        }
        Err(_) if wanted.exists() => Ok(()),
        Err(error) => Err(ToolError::io("write", entry)(error)),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;
    use crate::testing::MockHost;

    fn key(text: &str) -> Key {
        Key::builder("test").field("text", text).finish()
    }

    fn entries(cache: &Cache) -> Vec<String> {
        let names = fs::read_dir(cache.root()).unwrap();
        names.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    fn fill(dir: &Path) -> Result<(), ToolError> {
        fs::write(dir.join("file"), "built").map_err(ToolError::io("write", dir))
    }

    #[test]
    fn builds_once_per_key() {
        let cache = Cache::throw_away().unwrap();
        let count = AtomicU32::new(0);
        for text in ["a", "a", "b", "a"] {
            let path = cache.get_or_build(&key(text), "file", |dir| {
                count.fetch_add(1, Ordering::Relaxed);
                fill(dir)
            });
            assert_eq!(fs::read_to_string(path.unwrap()).unwrap(), "built");
        }
        assert_eq!(count.into_inner(), 2);
        assert_eq!(entries(&cache).len(), 2);
    }

    #[test]
    fn simultaneous_builds_of_one_key_agree() {
        let cache = Cache::throw_away().unwrap();
        let barrier = std::sync::Barrier::new(4);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let path = cache.get_or_build(&key("same"), "file", |dir| {
                        barrier.wait();
                        fill(dir)
                    });
                    assert!(path.unwrap().is_file());
                });
            }
        });
        assert_eq!(entries(&cache), [key("same").as_str()]);
    }

    #[test]
    fn a_failed_build_leaves_only_its_log() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::at(folder.path()).unwrap();
        let error = cache.get_or_build(&key("bad"), "file", |dir| {
            fill(dir)?;
            Err(ToolError::Failed {
                command: "cc".into(),
                status: "exit status: 1".into(),
                tail: "end".into(),
                full: "start\nend".into(),
                log: None,
            })
        });
        let Err(ToolError::Failed { log: Some(log), .. }) = error else { panic!("{error:?}") };
        assert_eq!(fs::read_to_string(log).unwrap(), "$ cc\nstart\nend\nexit status: 1\n");
        assert_eq!(entries(&cache), ["logs"]);
    }

    #[test]
    fn a_damaged_entry_is_built_again() {
        let cache = Cache::throw_away().unwrap();
        let path = cache.get_or_build(&key("x"), "file", fill).unwrap();
        fs::remove_file(&path).unwrap();
        assert!(cache.get_or_build(&key("x"), "file", fill).unwrap().is_file());
    }

    #[test]
    fn the_folder_follows_the_environment() {
        let root = |host: MockHost| Cache::from_host(&host).unwrap().root().to_owned();
        let home = || MockHost::new().variable("HOME", "/home/me");
        assert_eq!(root(home()), Path::new("/home/me/.cache/foveate"));
        let xdg = || home().variable("XDG_CACHE_HOME", "/xdg");
        assert_eq!(root(xdg()), Path::new("/xdg/foveate"));
        assert_eq!(root(xdg().variable("FOVEATE_CACHE", "/mine")), Path::new("/mine"));
        assert!(root(xdg().variable("FOVEATE_CACHE", "off")).starts_with(std::env::temp_dir()));
        assert!(matches!(Cache::from_host(&MockHost::new()), Err(ToolError::NoCache)));
    }

    #[test]
    fn old_rests_of_killed_builds_go() {
        let cache = Cache::throw_away().unwrap();
        let [old, new] = ["old", "new"].map(|name| cache.root().join(format!(".building-{name}")));
        fs::create_dir(&old).unwrap();
        fs::create_dir(&new).unwrap();
        let past = SystemTime::now() - STALE - Duration::from_secs(60);
        fs::File::open(&old).unwrap().set_modified(past).unwrap();
        cache.get_or_build(&key("x"), "file", fill).unwrap();
        assert!(!old.exists() && new.exists());
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_the_users_affair() {
        let error = Cache::at(Path::new("/proc/none/foveate")).unwrap();
        let error = error.get_or_build(&key("x"), "file", fill).unwrap_err();
        assert!(error.is_environment(), "{error:?}");
        let text = error.to_string();
        assert!(text.starts_with("cannot create `/proc/none/foveate`"), "{text}");
        assert!(text.contains("set FOVEATE_CACHE to a folder"), "{text}");
    }

    #[test]
    fn a_throw_away_cache_goes_away() {
        let cache = Cache::throw_away().unwrap();
        let path = cache.get_or_build(&key("x"), "file", fill).unwrap();
        drop(cache.clone());
        assert!(path.is_file());
        drop(cache);
        assert!(!path.exists());
    }
}
