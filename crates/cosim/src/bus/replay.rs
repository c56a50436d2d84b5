// SPDX-License-Identifier: MIT OR Apache-2.0
//! The replay folder of a failing run on the buses.

use crate::error::CosimError;
use crate::harness::rendered;
use crate::mismatch::Mismatch;
use crate::replay::{README, REPLAY, SCRIPT, TRAFFIC_FILE, copy_waves, make_executable, put};
use askama::Template;
use foveate_staging::StagedFolder;
use foveate_toolchain::Source;
use foveate_toolchain::text::shell_word;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Template)]
#[template(path = "axi_replay.sh")]
struct Script<'a> {
    top: &'a str,
    seed: u64,
    files: Vec<String>,
}

#[derive(Template)]
#[template(path = "axi_replay.md")]
struct Readme<'a> {
    top: &'a str,
    mismatch: &'a Mismatch,
    version: &'a str,
    seed: u64,
    fingerprint: &'a str,
}

/// The contents of a replay folder.
pub(super) struct Replay<'a> {
    pub(super) top: &'a str,
    pub(super) sources: &'a [Source],
    pub(super) program: &'a str,
    pub(super) traffic: &'a str,
    /// The file with the recorded port activity; `waves` is the file with waves, if they were asked
    /// for.
    pub(super) heard: &'a Path,
    pub(super) waves: Option<&'a Path>,
    pub(super) mismatch: &'a Mismatch,
    pub(super) version: &'a str,
    pub(super) seed: u64,
    pub(super) fingerprint: &'a str,
}

impl Replay<'_> {
    /// Writes the folder in place of an earlier one.
    pub(super) fn write(&self, folder: &Path) -> Result<PathBuf, CosimError> {
        let staged = StagedFolder::new(folder, REPLAY, true)?;
        self.fill(staged.folder()).map_err(|error| error.named(&staged))?;
        staged.commit()?;
        Ok(folder.to_owned())
    }

    fn fill(&self, dir: &Path) -> Result<(), CosimError> {
        let &Self { top, mismatch, version, seed, fingerprint, .. } = self;
        let files = self.sources.iter().map(|(name, _)| shell_word(name).into_owned()).collect();
        for (name, contents) in self.sources {
            put(dir, name, contents)?;
        }
        put(dir, "axi.cpp", self.program)?;
        put(dir, TRAFFIC_FILE, self.traffic)?;
        put(dir, SCRIPT, &rendered(&Script { top, seed, files }))?;
        put(dir, README, &rendered(&Readme { top, mismatch, version, seed, fingerprint }))?;
        make_executable(&dir.join(SCRIPT))?;
        let to = dir.join("heard_then.txt");
        fs::copy(self.heard, &to).map_err(CosimError::io("write", &to))?;
        self.waves.map_or(Ok(()), |waves| copy_waves(waves, dir))
    }
}
