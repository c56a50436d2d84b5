// SPDX-License-Identifier: MIT OR Apache-2.0
//! The build of a project: writes its files, runs its script, and reads the results.

use std::fs;
use std::path::Path;
use std::time::Duration;

use foveate_tools::{
    ContinuedFolder, FolderKind, Invocation, StagedFolder, StagingError, ToolError, Toolchain,
};
use serde::Serialize;
use serde_json::Value;

use crate::{BoardError, BoardProject};

/// The kind of folder that is written. Only folders of this kind are replaced.
pub const PROJECT_FOLDER: FolderKind = FolderKind {
    description: "a project of a board (its board.f and sim/board_clock.v)",
    matches: |folder| {
        folder.join("board.f").is_file() && folder.join("sim/board_clock.v").is_file()
    },
};

/// The script's file about the seed that it packs, written after all seeds are done.
const PACKED_FILE: &str = "build/packed";
/// The folder that the script makes.
const BUILD_FOLDER: &str = "build";
/// The time limit of the script. One seed takes minutes on a large device.
const SCRIPT_TIME: Duration = Duration::from_secs(4 * 3600);

/// A bitstream, and its use of the device.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BuildResult {
    /// The path of its file in the folder of the project.
    pub bitstream: String,
    /// The size in bytes.
    pub bytes: usize,
    /// The cells of the device that are used.
    pub used: Vec<CellUse>,
    /// The clock that the core needs, in MHz.
    pub core_mhz: u32,
    /// The clock of the core that each seed reaches, in MHz, the slowest first.
    pub reached_mhz: Vec<f64>,
    /// The clock of the core that the packed seed reaches, in MHz.
    pub packed_mhz: f64,
    /// The pixel clock that the sensor needs, in MHz.
    pub pclk_mhz: f64,
    /// The pixel clock that the packed seed reaches, in MHz.
    pub pclk_reached_mhz: f64,
}

impl BuildResult {
    /// Returns true if the packed seed reaches both clocks.
    #[must_use]
    pub fn is_fast_enough(&self) -> bool {
        self.packed_mhz >= f64::from(self.core_mhz) && self.pclk_reached_mhz >= self.pclk_mhz
    }
}

/// The cells of one type.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CellUse {
    /// The name of the type in nextpnr.
    pub cell: String,
    /// The number of used cells.
    pub used: u64,
    /// The number of cells in the device.
    pub available: u64,
}

/// Writes the files of a project into a folder, which appears when it is complete, and returns
/// their names. An earlier project in the folder is replaced, with the files that its script has
/// made, because they are on the list of its folder.
///
/// # Errors
/// Fails if the folder cannot be written, or if it holds anything else.
pub fn write_project(
    project: &BoardProject,
    folder: &Path,
    overwrite: bool,
) -> Result<Vec<String>, BoardError> {
    let staged = StagedFolder::new(folder, PROJECT_FOLDER, overwrite)?;
    let files = project.files();
    for file in &files {
        staged.write(&file.path, file.contents.as_bytes())?;
    }
    staged.commit()?;
    Ok(files.into_iter().map(|file| file.path).collect())
}

/// Runs the script of a project that has been written. A bitstream that is too slow is no error.
///
/// # Errors
/// Fails if a tool is missing or fails, or if the design does not fit the device.
pub fn build(
    project: &BoardProject,
    folder: &Path,
    seeds: u32,
    toolchain: &Toolchain,
) -> Result<BuildResult, BoardError> {
    if !project.is_open() {
        return Err(BoardError::NoOpenTool { name: project.board.name.clone() });
    }
    let run = Invocation::new("sh")
        .args(["build.sh", &seeds.to_string()])
        .dir(folder)
        .timeout(SCRIPT_TIME);
    let is_new = !folder.join(BUILD_FOLDER).exists();
    let result = toolchain.run_checked(&run);
    if is_new {
        list_made_files(project, folder)?;
    }
    match result {
        // The script has packed a bitstream, and reports that it is too slow.
        Err(ToolError::Failed { .. }) if folder.join(PACKED_FILE).is_file() => {}
        other => drop(other?),
    }
    let read_output = |name: &str| {
        let path = folder.join(name);
        fs::read(&path).map_err(|source| BoardError::MissingOutput { path, source })
    };
    // Each line has the clock of the core, the pixel clock, and the seed; the slowest seed is
    // first.
    let sorted = String::from_utf8_lossy(&read_output("build/sorted")?).into_owned();
    let line = |line: &str| -> Option<(f64, f64)> {
        let mut words = line.split(' ').map(str::parse);
        Some((words.next()?.ok()?, words.next()?.ok()?))
    };
    let clocks: Vec<_> = sorted.lines().filter_map(line).collect();
    let packed =
        line(String::from_utf8_lossy(&read_output(PACKED_FILE)?).trim_end()).unwrap_or_default();
    let bitstream = project.bitstream();
    let bytes = read_output(&bitstream)?.len();
    Ok(BuildResult {
        bitstream,
        bytes,
        used: used_cells(&read_output("build/report.json")?),
        core_mhz: project.board.clock.core_mhz,
        reached_mhz: clocks.iter().map(|clock| clock.0).collect(),
        pclk_mhz: project.pclk_mhz(),
        packed_mhz: packed.0,
        pclk_reached_mhz: packed.1,
    })
}

/// Adds the files that the script has made to the list of the folder. The script cannot do so when
/// it is stopped.
fn list_made_files(project: &BoardProject, folder: &Path) -> Result<(), StagingError> {
    let entries = fs::read_dir(folder.join(BUILD_FOLDER)).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let names = names.map(|name| format!("{BUILD_FOLDER}/{name}")).chain([project.bitstream()]);
    ContinuedFolder::open(folder)?.list_files(names)
}

/// Returns the cells in a report of nextpnr, without types of which no cell is used.
fn used_cells(report: &[u8]) -> Vec<CellUse> {
    let report: Value = serde_json::from_slice(report).unwrap_or_default();
    let cells = report["utilization"].as_object().into_iter().flatten();
    let number = |value: &Value| value.as_u64().unwrap_or(0);
    cells
        .map(|(cell, counts)| CellUse {
            cell: cell.clone(),
            used: number(&counts["used"]),
            available: number(&counts["available"]),
        })
        .filter(|cell| cell.used > 0)
        .collect()
}
