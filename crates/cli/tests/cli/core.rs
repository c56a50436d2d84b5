// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the benches that come with a core, by the commands of the core's own README.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::run_successfully;
use foveate_tools::{
    Tool,
    testing::{require_tools, sample, takes_whole_lists},
};

/// Runs `tb/replay.sh` as the README says, without Foveate. Returns its exit code and its output.
fn replay(core: &Path, args: &[&str]) -> (Option<i32>, String) {
    let readme = fs::read_to_string(core.join("README.md")).unwrap();
    assert!(readme.contains("    sh tb/replay.sh\n"), "{readme}");
    let output =
        Command::new("sh").arg("tb/replay.sh").args(args).current_dir(core).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    (output.status.code(), text + &String::from_utf8_lossy(&output.stderr))
}

fn core(folder: &Path, settings: &[&str]) {
    // Some tests edit the core, and edited files are not replaced.
    let _ = fs::remove_dir_all(folder.join("core"));
    let mut args = vec!["generate", "--preset", "bare", "-o", "core"];
    for setting in settings {
        args.extend(["--set", setting]);
    }
    run_successfully(folder, &args);
}

fn edit(file: &Path, from: &str, to: &str) {
    let text = fs::read_to_string(file).unwrap();
    assert!(text.contains(from), "{from}");
    fs::write(file, text.replace(from, to)).unwrap();
}

#[test]
fn the_bench_of_a_pipelined_core_finds_an_edited_leaf() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    core(dir.path(), &[]);
    let folder = dir.path().join("core");
    let (code, text) = replay(&folder, &[]);
    assert_eq!(code, Some(0), "{text}");
    let lines: Vec<_> = text.lines().collect();
    assert!(lines.len() == 2 && lines[0].starts_with("rpu: PASS "), "{text}");
    assert!(lines[1].starts_with("rcm: PASS "), "{text}");
    edit(&folder.join("rtl/vote.v"), "score_i >= minimum_i", "score_i > minimum_i");
    for (args, verdicts) in [(&[][..], 2), (&["rcm"], 1), (&["rpu", "iverilog"], 1)] {
        let (code, text) = replay(&folder, args);
        assert_eq!(
            (code, text.matches(": FAIL ").count()),
            (Some(1), verdicts),
            "{args:?}: {text}"
        );
    }
    // A fault in the array alone is found by the bench of the array alone.
    core(dir.path(), &[]);
    edit(&folder.join("rtl/rcm.v"), ".pixel_i(pixel_i[REGION*8+:8])", ".pixel_i(pixel_i[7:0])");
    assert_eq!(replay(&folder, &["rpu"]).0, Some(0));
    assert_eq!(replay(&folder, &["all"]).0, Some(1));
    for args in [&["rtl"][..], &["rpu", "vcs"]] {
        assert_eq!(replay(&folder, args).0, Some(2), "{args:?}");
    }
}

/// The README gives these commands to users without the script, together with the exit code of the
/// simulator.
#[test]
fn the_bench_runs_by_hand_and_in_verilator() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp, Tool::Verilator]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    core(dir.path(), &["region.size=4", "frame={width=8,height=4}"]);
    let folder = dir.path().join("core");
    let readme = fs::read_to_string(folder.join("README.md")).unwrap();
    let commands: Vec<_> = readme
        .lines()
        .filter_map(|line| line.strip_prefix("    "))
        .filter(|line| line.starts_with("iverilog ") || line.starts_with("vvp "))
        .collect();
    assert_eq!(commands.len(), 2, "{readme}");
    let by_hand = || {
        let script = commands.join("\n");
        let output =
            Command::new("sh").args(["-ec", &script]).current_dir(&folder).output().unwrap();
        (output.status.success(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let (is_success, text) = by_hand();
    assert!(is_success && text.starts_with("PASS "), "{text}");
    if takes_whole_lists() {
        let (code, text) = replay(&folder, &["all", "verilator"]);
        assert_eq!((code, text.matches(": PASS ").count()), (Some(0), 2), "{text}");
    }
    edit(
        &folder.join("rtl/decision.v"),
        "assign active_o  = srs_o",
        "assign active_o  = 1'b0 & srs_o",
    );
    let (is_success, text) = by_hand();
    assert!(!is_success && text.contains("FAIL ") && text.contains("port active_o"), "{text}");
    let (code, text) = replay(&folder, &["rcm", "verilator"]);
    assert!(code == Some(1) && text.contains("rcm: FAIL "), "{text}");
}

/// The instantiation template of the README is Verilog, and every port has the width of the core's.
#[test]
fn the_instance_of_the_readme_fits_the_core() {
    if !require_tools(&[Tool::Iverilog]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let serial = "hardware={organization='serial',fold=5,feed='raster'}";
    let lanes = "hardware={organization='serial',fold=5}";
    let constant = "hardware.thresholds='constant'";
    let raster = "hardware={organization='raster',pixels_per_clock=2}";
    let frame = "frame={width=30,height=20}";
    for settings in
        [&[frame][..], &[frame, constant], &[frame, serial], &[frame, lanes], &[frame, raster]]
    {
        let folder = dir.path().join("core");
        // The files that the last round compiled there are not Foveate's.
        let _ = fs::remove_dir_all(&folder);
        core(dir.path(), settings);
        let readme = fs::read_to_string(folder.join("README.md")).unwrap();
        let (_, rest) = readme.split_once("```verilog\n").unwrap();
        let (instance, _) = rest.split_once("```").unwrap();
        let compile = |instance: &str| {
            let top = format!("`default_nettype none\nmodule mine;\n{instance}\nendmodule\n");
            fs::write(folder.join("mine.v"), top).unwrap();
            let args = ["-g2005", "-Wall", "-s", "mine", "-o", "mine.vvp", "-f", "rcm.f", "mine.v"];
            let output = Command::new("iverilog").args(args).current_dir(&folder).output().unwrap();
            let log = String::from_utf8_lossy(&output.stderr).into_owned();
            output.status.success() && !log.contains("expects") && !log.contains("dangling")
        };
        assert!(compile(instance), "{settings:?}\n{instance}");
        let wide = instance.replacen("wire [", "wire [1+", 1);
        assert!(!compile(&wide), "a port that is too wide is noticed: {wide}");
    }
}

/// No frame makes a region of this design active. `generate` warns about that, and the benches do
/// not pass.
#[test]
fn a_core_whose_vectors_show_too_little_never_passes() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let never = "spatial=[{feature='edge',level=1529,min_score=64}]";
    let constant = "hardware.thresholds='constant'";
    let args = ["generate", "--preset", "bare", "-o", "core", "--set", never, "--set", constant];
    let outcome = crate::common::run_in(dir.path(), &args);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    for top in ["rpu", "rcm"] {
        let words = format!("warning: tb/{top}_replay.v does not test all of `{top}`");
        assert!(outcome.stderr.contains(&words), "{}", outcome.stderr);
    }
    let (code, text) = replay(&dir.path().join("core"), &[]);
    assert_eq!((code, text.matches(": INCOMPLETE ").count()), (Some(1), 2), "{text}");
    assert!(text.contains("no region is active") && !text.contains("PASS"), "{text}");
}

#[test]
fn the_bench_of_a_serial_core_finds_an_edited_leaf() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let serial = "hardware.organization='serial'";
    let folder = dir.path().join("core");
    let designs: [&[&str]; 3] = [
        &[serial, "denoise.filter='none'"],
        &[serial, "region.size=4", "hardware.fold=3", "hardware.feed='raster'"],
        &[
            serial,
            "hardware.fold=3",
            "hardware.thresholds='constant'",
            "denoise.filter='median3x3'",
        ],
    ];
    for settings in sample(designs, 3) {
        core(dir.path(), &[settings, &["frame={width=32,height=16}"]].concat());
        let (code, text) = replay(&folder, &[]);
        assert_eq!((code, text.matches(": PASS ").count()), (Some(0), 2), "{settings:?}: {text}");
    }
    // The vectors reach every stage of a frame: votes, Table I, and pixels that leave.
    let faults = [
        ("serial_decision", "score_o >= minimum", "score_o < minimum", "_o expected"),
        (
            "serial_addresses",
            "REFERENCE_AT + position",
            "REFERENCE_AT + position + 1",
            "forward_pixel_o",
        ),
    ];
    for (leaf, from, to, port) in faults {
        core(
            dir.path(),
            &[serial, "region.size=4", "hardware.fold=2", "frame={width=24,height=16}"],
        );
        edit(&folder.join(format!("rtl/{leaf}.v")), from, to);
        let (code, text) = replay(&folder, &["rpu", "iverilog"]);
        assert!(
            code == Some(1) && text.contains(": FAIL ") && text.contains(port),
            "{leaf}: {text}"
        );
    }
}

#[test]
fn the_bench_of_a_raster_core_finds_an_edited_leaf() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let raster = "hardware={organization='raster',pixels_per_clock=2}";
    let frame = "frame={width=64,height=48}";
    let folder = dir.path().join("core");
    core(dir.path(), &[raster, frame]);
    let (code, text) = replay(&folder, &[]);
    assert_eq!((code, text.matches(": PASS ").count()), (Some(0), 1), "{text}");
    let readme = fs::read_to_string(folder.join("README.md")).unwrap();
    assert!(readme.contains("## A live stream"), "{readme}");
    // The vectors reach votes and a lost region.
    for (leaf, from, to, port) in [
        ("vote", "score_i >= minimum_i", "score_i > minimum_i", "_o expected"),
        ("raster_readout", "assign lost_o = held_stale ||", "assign lost_o = 1'b0 &&", "lost_o"),
    ] {
        core(dir.path(), &[raster, frame]);
        edit(&folder.join(format!("rtl/{leaf}.v")), from, to);
        let (code, text) = replay(&folder, &["rcm", "iverilog"]);
        let fails = code == Some(1) && text.contains(": FAIL ") && text.contains(port);
        assert!(fails, "{leaf}: {text}");
    }
}
