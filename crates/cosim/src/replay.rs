// SPDX-License-Identifier: MIT OR Apache-2.0
//! The folder of a failing run, with Verilog and benches that reproduce the mismatch without
//! Foveate ([`write_replay`]).

use crate::error::CosimError;
use crate::harness::{bench_file, bench_name, render, replay_bench};
use crate::mismatch::Mismatch;
use crate::recording::{Recording, VECTORS_FILE};
use crate::simulation::{DesignUnderTest, SimulationOutcome, SimulationRun, Simulator, WAVES_FILE};
use askama::Template;
use foveate_tools::escaping::shell_word;
use foveate_tools::{FolderKind, StagedFolder};
use std::fs;
use std::path::{Path, PathBuf};

pub(crate) const SCRIPT: &str = "replay.sh";

pub(crate) const README: &str = "README.md";

/// The name of the file with the traffic of a core on a bus.
pub(crate) const TRAFFIC_FILE: &str = "traffic.txt";

/// The kind of folder that is written, and the only kind that may be replaced.
pub const REPLAY: FolderKind = FolderKind {
    description: "a replay (its replay.sh) or waves (its waves.fst)",
    matches: |folder| [SCRIPT, WAVES_FILE].iter().any(|name| folder.join(name).is_file()),
};

/// The number of clocks that are kept after the last port's first mismatch.
const KEPT_CLOCKS: u64 = 16;

#[derive(Template)]
#[template(path = "replay.sh")]
struct ReplayScript<'a> {
    top: &'a str,
    bench: String,
    bench_file: String,
    vectors_file: &'a str,
    simulator: Simulator,
    seed: u64,
    files: Vec<String>,
}

#[derive(Template)]
#[template(path = "replay.md")]
struct ReplayReadme<'a> {
    top: &'a str,
    bench_file: String,
    vectors_file: &'a str,
    mismatch: &'a Mismatch,
    clocks: u64,
    version: &'a str,
    seed: u64,
    fingerprint: &'a str,
}

pub(crate) struct ReplaySubject<'a> {
    pub(crate) mismatch: &'a Mismatch,
    pub(crate) fingerprint: &'a str,
}

/// Refuses a folder that holds something else, before anything is simulated.
pub(crate) fn check_folder(folder: &Path) -> Result<(), CosimError> {
    Ok(StagedFolder::check(folder, REPLAY, true)?)
}

/// Removes the replay of an earlier run, so that it is not mistaken for that of this run.
pub(crate) fn remove_earlier(folder: &Path) -> Result<(), CosimError> {
    Ok(StagedFolder::remove(folder, REPLAY)?)
}

/// Writes the folder under a temporary name, then moves it to its place, where it replaces an
/// earlier replay.
pub(crate) fn write_replay(
    folder: &Path,
    run: &SimulationRun<'_>,
    dut: &DesignUnderTest,
    recording: &Recording,
    outcome: &SimulationOutcome,
    about: &ReplaySubject<'_>,
) -> Result<PathBuf, CosimError> {
    let staged = StagedFolder::new(folder, REPLAY, true)?;
    fill_folder(staged.folder(), run, dut, recording, outcome, about)
        .map_err(|error| error.with_final_paths(&staged))?;
    staged.commit()?;
    Ok(folder.to_owned())
}

/// Writes the folder of a run without a mismatch whose waves were asked for.
pub(crate) fn write_waves(folder: &Path, waves: &Path) -> Result<PathBuf, CosimError> {
    let staged = StagedFolder::new(folder, REPLAY, true)?;
    copy_waves(waves, staged.folder()).map_err(|error| error.with_final_paths(&staged))?;
    staged.commit()?;
    Ok(folder.join(WAVES_FILE))
}

pub(crate) fn copy_waves(waves: &Path, dir: &Path) -> Result<(), CosimError> {
    let to = dir.join(WAVES_FILE);
    fs::copy(waves, &to).map(drop).map_err(CosimError::io("write", &to))
}

fn fill_folder(
    dir: &Path,
    run: &SimulationRun<'_>,
    dut: &DesignUnderTest,
    recording: &Recording,
    outcome: &SimulationOutcome,
    about: &ReplaySubject<'_>,
) -> Result<(), CosimError> {
    let last = about.mismatch.ports.iter().map(|port| port.clock).max();
    let last = last.unwrap_or(about.mismatch.clock);
    let limit = last.saturating_add(KEPT_CLOCKS).min(recording.clocks());
    let bench = replay_bench(&dut.top, &dut.ports, &dut.parameters);
    let files = dut.sources.iter().map(|(name, _)| shell_word(name).into_owned()).collect();
    let script = render(&ReplayScript {
        top: &dut.top,
        bench: bench_name(&dut.top),
        bench_file: bench_file(&dut.top),
        vectors_file: VECTORS_FILE,
        simulator: run.simulator,
        seed: run.seed,
        files,
    });
    let readme = render(&ReplayReadme {
        top: &dut.top,
        bench_file: bench_file(&dut.top),
        vectors_file: VECTORS_FILE,
        mismatch: about.mismatch,
        clocks: limit,
        version: &outcome.version,
        seed: run.seed,
        fingerprint: about.fingerprint,
    });
    for (name, contents) in &dut.sources {
        write_file(dir, name, contents)?;
    }
    write_file(dir, &bench_file(&dut.top), &bench)?;
    write_file(dir, README, &readme)?;
    write_file(dir, SCRIPT, &script)?;
    make_executable(&dir.join(SCRIPT))?;
    recording.write_hex(&dir.join(VECTORS_FILE), limit)?;
    outcome.waves.as_ref().map_or(Ok(()), |waves| copy_waves(waves, dir))
}

pub(crate) fn write_file(dir: &Path, name: &str, contents: &str) -> Result<(), CosimError> {
    let path = dir.join(name);
    if let Some(parent) = path.parent() {
        fs::create_dir_all(parent).map_err(CosimError::io("create", parent))?;
    }
    fs::write(&path, contents).map_err(CosimError::io("write", &path))
}

#[cfg(unix)]
pub(crate) fn make_executable(path: &Path) -> Result<(), CosimError> {
    use std::os::unix::fs::PermissionsExt as _;
    let mode = fs::Permissions::from_mode(0o755);
    fs::set_permissions(path, mode).map_err(CosimError::io("write", path))
}

#[cfg(not(unix))]
pub(crate) fn make_executable(_: &Path) -> Result<(), CosimError> {
    Ok(())
}
