// SPDX-License-Identifier: MIT OR Apache-2.0
//! The replay folder of a failing run on the buses.

use crate::error::CosimError;
use crate::harness::render;
use crate::mismatch::Mismatch;
use crate::replay::{
    README, REPLAY, SCRIPT, TRAFFIC_FILE, copy_waves, make_executable, write_file,
};
use askama::Template;
use foveate_tools::{Source, StagedFolder, escaping::shell_word};
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Template)]
#[template(path = "axi_replay.sh")]
struct BusReplayScript<'a> {
    top: &'a str,
    seed: u64,
    files: Vec<String>,
}

#[derive(Template)]
#[template(path = "axi_replay.md")]
struct BusReplayReadme<'a> {
    top: &'a str,
    mismatch: &'a Mismatch,
    version: &'a str,
    seed: u64,
    fingerprint: &'a str,
}

/// The contents of a replay folder.
pub(super) struct BusReplay<'a> {
    pub(super) top: &'a str,
    pub(super) sources: &'a [Source],
    pub(super) program: &'a str,
    pub(super) traffic: &'a str,
    /// The file with the recorded port activity; `waves` is the file with waves, if they were asked
    /// for.
    pub(super) record_file: &'a Path,
    pub(super) wave_file: Option<&'a Path>,
    pub(super) mismatch: &'a Mismatch,
    pub(super) version: &'a str,
    pub(super) seed: u64,
    pub(super) fingerprint: &'a str,
}

impl BusReplay<'_> {
    /// Writes the folder in place of an earlier one.
    pub(super) fn write(&self, folder: &Path) -> Result<PathBuf, CosimError> {
        let staged = StagedFolder::new(folder, REPLAY, true)?;
        self.fill(staged.folder()).map_err(|error| error.with_final_paths(&staged))?;
        staged.commit()?;
        Ok(folder.to_owned())
    }

    fn fill(&self, dir: &Path) -> Result<(), CosimError> {
        let &Self { top, mismatch, version, seed, fingerprint, .. } = self;
        let files = self.sources.iter().map(|(name, _)| shell_word(name).into_owned()).collect();
        for (name, contents) in self.sources {
            write_file(dir, name, contents)?;
        }
        write_file(dir, "axi.cpp", self.program)?;
        write_file(dir, TRAFFIC_FILE, self.traffic)?;
        write_file(dir, SCRIPT, &render(&BusReplayScript { top, seed, files }))?;
        write_file(
            dir,
            README,
            &render(&BusReplayReadme { top, mismatch, version, seed, fingerprint }),
        )?;
        make_executable(&dir.join(SCRIPT))?;
        let to = dir.join("heard_then.txt");
        fs::copy(self.record_file, &to).map_err(CosimError::io("write", &to))?;
        self.wave_file.map_or(Ok(()), |waves| copy_waves(waves, dir))
    }
}
