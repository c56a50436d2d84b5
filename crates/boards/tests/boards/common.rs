// SPDX-License-Identifier: MIT OR Apache-2.0
//! A small board, compiled for a bench, and its runs.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use foveate_boards::{Board, BoardError, BoardProject};
use foveate_design::{DesignConfig, Preset};
use foveate_tools::{
    Cache, Source, Toolchain,
    verilator::{self, LintMode, VerilatorJob},
};

const BENCH: &str = include_str!("board_bench.v");
const SENSOR: &str = include_str!("sensor.cpp");
const SERIAL: &str = include_str!("serial.h");
pub(crate) const CORE_MHZ: u32 = 24;
/// The number of clocks without a byte after which a run ends.
const QUIET_CLOCKS: u32 = 30_000;

/// Returns a board with this sensor, before a core for small frames.
pub(crate) fn project(sensor: &str, keys: &[&str]) -> BoardProject {
    let lines = if sensor == "hm01b0-4" { 4 } else { 8 };
    let data: Vec<_> = (0..lines).map(|line| format!("\"d{line}\"")).collect();
    let toml = format!(
        "title = 'a board'\npage = 'https://example.org'\nsensor = '{sensor}'\nflash = 'load'\n\
         [device]\nfamily = 'ice40'\npart = 'up5k'\npackage = 'sg48'\n\
         [clock]\npins = ['35']\nmhz = 12\ncore_mhz = {CORE_MHZ}\n[serial]\ntx = 't'\nrx = 'r'\nbaud = 6_000_000\n\
         [leds]\npins = ['l0', 'l1']\nlit = 'high'\n\
         [pins]\nxclk = 'x'\npclk = 'p'\nvsync = 'v'\nhref = 'h'\nscl = 'c'\nsda = 'a'\ndata = [{}]\n\
         [design]\npreset = 'raster'\nset = ['frame={{width=64,height=48}}', \"render.irrelevant='mean'\", \
         'periphery={{blocks=2,level=4}}'{}]\n",
        data.join(","),
        keys.iter().map(|key| format!(", \"{key}\"")).collect::<String>()
    );
    let board = Board::from_toml("bench", &toml).unwrap();
    let design = board.config().unwrap().validate().unwrap();
    BoardProject::new(board, design).unwrap()
}

/// Returns the array of the paper on a VCU118, with changed keys.
pub(crate) fn array(keys: &[&str]) -> Result<BoardProject, BoardError> {
    array_on(Board::find("vcu118").unwrap(), keys)
}

/// Returns the array of the paper on a board, with changed keys.
pub(crate) fn array_on(board: Board, keys: &[&str]) -> Result<BoardProject, BoardError> {
    let paper = Preset::find("paper").unwrap().toml;
    BoardProject::new(board, DesignConfig::from_toml_with(paper, keys).unwrap().validate().unwrap())
}

/// Returns true if there is an interpreter of Tcl. Panics if there is none although all tools are
/// required.
pub(crate) fn has_tclsh() -> bool {
    let is_installed = Command::new("tclsh").stdin(Stdio::null()).output().is_ok();
    let is_strict = std::env::var_os("FOVEATE_REQUIRE_TOOLS").is_some_and(|value| value == "1");
    assert!(
        is_installed || !is_strict,
        "FOVEATE_REQUIRE_TOOLS is 1, and tclsh is missing (Debian: tcl)"
    );
    is_installed
}

/// A planted fault: the module, a text in it, and the text that replaces it.
pub(crate) type PlantedFault<'a> = Option<(&'a str, &'a str, &'a str)>;

/// Returns the Verilog of a project with the clock for simulations in place of its PLL. A fault may
/// be planted in it.
pub(crate) fn verilog(project: &BoardProject, fault: PlantedFault<'_>) -> Vec<Source> {
    let mut files = project.files();
    if let Some((name, from, to)) = fault {
        let path = format!("rtl/{name}.v");
        let file = files.iter_mut().find(|file| file.path == path).unwrap();
        assert_eq!(file.contents.matches(from).count(), 1, "`{from}` in {path}");
        file.contents = file.contents.replace(from, to);
    }
    let text = |path: &str| files.iter().find(|file| file.path == path).unwrap().contents.clone();
    let source = |path: &str| {
        let from = if path == "rtl/board_clock.v" { "sim/board_clock.v" } else { path };
        Source::from((path.to_owned(), text(from)))
    };
    text("board.f").lines().map(source).collect()
}

/// Compiles a program that simulates these modules, with constants, the host's end of the serial
/// line, and a main function.
pub(crate) fn compile(sources: Vec<Source>, top: &str, constants: &str, main: &str) -> PathBuf {
    let (top, cpp_main) = (top.to_owned(), format!("{constants}{SERIAL}{main}"));
    let job =
        VerilatorJob { sources, top, cpp_main, lint: LintMode::Lenient, ..VerilatorJob::default() };
    verilator::build(&Toolchain::system(), &Cache::from_env().unwrap(), &job).unwrap()
}

/// Compiles a project with a sensor for Verilator.
pub(crate) fn compile_with_sensor(project: &BoardProject, fault: PlantedFault<'_>) -> PathBuf {
    let mut sources = verilog(project, fault);
    let (sensor, _) = project.board.sensor_with_pins().unwrap().unwrap();
    let bench = format!("`define DATA {}\n{BENCH}", sensor.format.data_lines());
    sources.push(Source::from(("board_bench.v".to_owned(), bench)));
    let constants =
        format!("#define DIVISOR 4\n#define MHZ {CORE_MHZ}\n#define QUIET {QUIET_CLOCKS}\n");
    compile(sources, "board_bench", &constants, SENSOR)
}

/// The results of a run.
pub(crate) struct SerialRun {
    pub(crate) bytes: Vec<u8>,
    /// True if a byte had no stop bit.
    pub(crate) has_broken_bytes: bool,
    /// The writes on I2C, and the LEDs.
    pub(crate) setup: String,
}

/// Runs a board. `host` has the bytes that the host sends, each with its earliest time in
/// microseconds.
pub(crate) fn run_board(
    program: &Path,
    wires: &[u8],
    host: &[(u32, u8)],
    pclk_ps: u32,
    nacks: u32,
) -> SerialRun {
    let dir = tempfile::tempdir().unwrap();
    let host: Vec<u8> =
        host.iter().flat_map(|(at, byte)| at.to_le_bytes().into_iter().chain([*byte])).collect();
    fs::write(dir.path().join("wires"), wires).unwrap();
    fs::write(dir.path().join("host"), host).unwrap();
    let run = Command::new(program)
        .arg(dir.path())
        .args([pclk_ps.to_string(), nacks.to_string()])
        .status()
        .unwrap();
    let setup = fs::read_to_string(dir.path().join("setup")).unwrap();
    let bytes = fs::read(dir.path().join("heard")).unwrap();
    SerialRun { bytes, has_broken_bytes: !run.success(), setup }
}
