// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes a project, runs its script, and reads what came of it.

use std::fs;
use std::path::Path;
use std::time::Duration;

use foveate_staging::{ContinuedFolder, FolderKind, StagedFolder, StagingError};
use foveate_toolchain::{Invocation, ToolError, Toolchain};
use serde::Serialize;
use serde_json::Value;

use crate::{BoardError, Project};

/// The folder that is written, and the only kind that it replaces.
pub const PROJECT: FolderKind = FolderKind {
    what: "a project of a board (its board.f and sim/board_clock.v)",
    is: |folder| folder.join("board.f").is_file() && folder.join("sim/board_clock.v").is_file(),
};

/// What the script writes of the seed that it packs, once that is done for all seeds.
const PACKED: &str = "build/packed";
/// The folder that the script makes.
const BUILD: &str = "build";
/// One seed takes minutes on a large device.
const LIMIT: Duration = Duration::from_secs(4 * 3600);

/// A bitstream, and what it takes of the device.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Built {
    /// Its file in the folder of the project.
    pub bitstream: String,
    /// Its size.
    pub bytes: usize,
    /// What of the device is used: cell of the device as nextpnr calls it, those used, those there.
    pub used: Vec<Used>,
    /// The clock of the core in MHz: needed, and of each seed, the slowest first.
    pub core_mhz: u32,
    /// The clock of each seed, the slowest first.
    pub reached_mhz: Vec<f64>,
    /// That of the seed that is packed.
    pub packed_mhz: f64,
    /// The clock of the sensor's pixels in MHz: needed.
    pub pclk_mhz: f64,
    /// What the packed seed reaches of it.
    pub pclk_reached_mhz: f64,
}

impl Built {
    /// Whether the packed seed reaches both clocks.
    #[must_use]
    pub fn is_fast_enough(&self) -> bool {
        self.packed_mhz >= f64::from(self.core_mhz) && self.pclk_reached_mhz >= self.pclk_mhz
    }
}

/// Cells of a kind.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Used {
    /// What nextpnr calls them.
    pub cell: String,
    /// Those that are used.
    pub used: u64,
    /// Those that are there.
    pub available: u64,
}

/// Writes the files of a project into a folder, which appears when it is complete. Returns their names. What the script of an
/// earlier project has made is on the list of its folder, so that it makes way, too.
///
/// # Errors
/// When the folder cannot be written, or holds something else.
pub fn write_project(
    project: &Project,
    folder: &Path,
    overwrite: bool,
) -> Result<Vec<String>, BoardError> {
    let staged = StagedFolder::new(folder, PROJECT, overwrite)?;
    let files = project.files();
    for file in &files {
        staged.write(&file.path, file.contents.as_bytes())?;
    }
    staged.commit()?;
    Ok(files.into_iter().map(|file| file.path).collect())
}

/// Runs the script of a project that has been written. A bitstream that is too slow is one, too.
///
/// # Errors
/// When a tool is missing or fails, and when the design does not fit.
pub fn build(
    project: &Project,
    folder: &Path,
    seeds: u32,
    toolchain: &Toolchain,
) -> Result<Built, BoardError> {
    if !project.is_open() {
        return Err(BoardError::Closed { name: project.board.name.clone() });
    }
    let run =
        Invocation::new("sh").args(["build.sh", &seeds.to_string()]).dir(folder).timeout(LIMIT);
    let is_new = !folder.join(BUILD).exists();
    let ran = toolchain.run_checked(&run);
    if is_new {
        list_made(project, folder)?;
    }
    match ran {
        // It has packed something, and says that it is too slow.
        Err(ToolError::Failed { .. }) if folder.join(PACKED).is_file() => {}
        other => drop(other?),
    }
    let left = |name: &str| {
        let path = folder.join(name);
        fs::read(&path).map_err(|source| BoardError::Left { path, source })
    };
    // Clock of the core, that of the pixels, and the seed, on a line each, the slowest first.
    let sorted = String::from_utf8_lossy(&left("build/sorted")?).into_owned();
    let line = |line: &str| -> Option<(f64, f64)> {
        let mut words = line.split(' ').map(str::parse);
        Some((words.next()?.ok()?, words.next()?.ok()?))
    };
    let clocks: Vec<_> = sorted.lines().filter_map(line).collect();
    let packed = line(String::from_utf8_lossy(&left(PACKED)?).trim_end()).unwrap_or_default();
    let bitstream = project.bitstream();
    let bytes = left(&bitstream)?.len();
    Ok(Built {
        bitstream,
        bytes,
        used: used(&left("build/report.json")?),
        core_mhz: project.board.clock.core_mhz,
        reached_mhz: clocks.iter().map(|clock| clock.0).collect(),
        pclk_mhz: project.pclk_mhz(),
        packed_mhz: packed.0,
        pclk_reached_mhz: packed.1,
    })
}

/// Lists what the script has made, which cannot do so itself when it is stopped.
fn list_made(project: &Project, folder: &Path) -> Result<(), StagingError> {
    let made = fs::read_dir(folder.join(BUILD)).into_iter().flatten().flatten();
    let names = made.filter_map(|entry| entry.file_name().into_string().ok());
    let names = names.map(|name| format!("{BUILD}/{name}")).chain([project.bitstream()]);
    ContinuedFolder::open(folder)?.note(names)
}

/// What a report of nextpnr says of the cells, without those of which none is used.
fn used(report: &[u8]) -> Vec<Used> {
    let report: Value = serde_json::from_slice(report).unwrap_or_default();
    let cells = report["utilization"].as_object().into_iter().flatten();
    let number = |value: &Value| value.as_u64().unwrap_or(0);
    cells
        .map(|(cell, counts)| Used {
            cell: cell.clone(),
            used: number(&counts["used"]),
            available: number(&counts["available"]),
        })
        .filter(|cell| cell.used > 0)
        .collect()
}
