// SPDX-License-Identifier: MIT OR Apache-2.0
//! The output folder, all or nothing: written beside its place and renamed when it is complete.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::cannot_write;
use crate::SimulatorError;

/// A folder in the making; dropped before [`Staging::commit`] it is removed.
pub(crate) struct Staging {
    target: PathBuf,
    partial: PathBuf,
    overwrite: bool,
}

impl Staging {
    /// Checks that `target` may be written and makes the folder beside it; folders above it that
    /// are missing are made too.
    pub(crate) fn new(target: &Path, overwrite: bool) -> Result<Self, SimulatorError> {
        let unnamed = || SimulatorError::OutputName { path: target.to_owned() };
        let place = std::path::absolute(target).map_err(|_| unnamed())?;
        let place = place.canonicalize().unwrap_or(place);
        let (Some(parent), Some(name)) = (place.parent(), place.file_name()) else {
            return Err(unnamed());
        };
        refuse_occupied(target, overwrite)?;
        fs::create_dir_all(parent).map_err(cannot_write(target))?;
        let stem = parent.join(format!(".{}.partial", name.to_string_lossy()));
        let partial = make_fresh(&stem).map_err(cannot_write(target))?;
        Ok(Self { target: place, partial, overwrite })
    }

    /// Where to write.
    pub(crate) fn folder(&self) -> &Path {
        &self.partial
    }

    /// Moves the folder to its place.
    pub(crate) fn commit(self) -> Result<(), SimulatorError> {
        refuse_occupied(&self.target, self.overwrite)?;
        let failed = cannot_write(&self.target);
        if !self.target.exists() {
            return fs::rename(&self.partial, &self.target).map_err(failed);
        }
        // The name is taken before the old folder goes, so that one of the two is always there.
        let mut aside = self.partial.clone().into_os_string();
        aside.push(".old");
        let aside = PathBuf::from(aside);
        fs::rename(&self.target, &aside).map_err(&failed)?;
        if let Err(error) = fs::rename(&self.partial, &self.target) {
            let _ = fs::rename(&aside, &self.target);
            return Err(failed(error));
        }
        fs::remove_dir_all(&aside).map_err(cannot_write(&aside))
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // After a commit it is not there any more.
        let _ = fs::remove_dir_all(&self.partial);
    }
}

/// Makes a folder that did not exist.
fn make_fresh(stem: &Path) -> io::Result<PathBuf> {
    const ATTEMPTS: u32 = 100;
    let mut result = Err(io::ErrorKind::AlreadyExists.into());
    for attempt in 0..ATTEMPTS {
        let mut name = stem.as_os_str().to_owned();
        name.push(format!("-{}-{attempt}", std::process::id()));
        let path = PathBuf::from(name);
        result = fs::create_dir(&path).map(|()| path);
        if !matches!(&result, Err(error) if error.kind() == io::ErrorKind::AlreadyExists) {
            break;
        }
    }
    result
}

/// An empty folder may be written; any other only when asked, and only if a simulation wrote it.
fn refuse_occupied(target: &Path, overwrite: bool) -> Result<(), SimulatorError> {
    let path = || target.to_owned();
    let mut entries = match fs::read_dir(target) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(SimulatorError::Write { path: path(), source }),
    };
    if entries.next().is_none() {
        return Ok(());
    }
    match (overwrite, is_ours(target)) {
        (false, _) => Err(SimulatorError::OutputNotEmpty { path: path() }),
        (true, false) => Err(SimulatorError::OutputForeign { path: path() }),
        (true, true) => Ok(()),
    }
}

fn is_ours(folder: &Path) -> bool {
    let summary = fs::read(folder.join("summary.json")).unwrap_or_default();
    serde_json::from_slice::<serde_json::Value>(&summary)
        .is_ok_and(|value| value.get("foveate_version").is_some())
}
