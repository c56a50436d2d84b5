// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `cosim` with serial designs, end to end.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{run_in, run_successfully};
use foveate_tools::{
    Tool,
    testing::{data_folder, require_tools},
};
use serde_json::Value;

const SIMULATORS: &[Tool] = &[Tool::Verilator, Tool::Cxx, Tool::Iverilog, Tool::Vvp];
/// A configuration with small regions, two of them per lane.
const FOLDED: &str = "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
                      [hardware]\norganization = \"serial\"\nfold = 2\n";

fn write_config(folder: &Path, config: &str) {
    fs::write(folder.join("camera.toml"), config).unwrap();
}

fn cosim(folder: &Path, extra: &[&str]) -> Value {
    let args = ["cosim", "--config", "camera.toml", "--json"];
    let printed = run_successfully(folder, &[&args[..], extra].concat());
    let summary: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(summary["passed"], true, "{summary}");
    summary["runs"][0].clone()
}

#[test]
#[ignore = "three simulators are compiled; scripts/release.sh whole runs it"]
fn serial_model_and_rtl_agree_at_every_level() {
    if !require_tools(SIMULATORS) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_config(dir.path(), FOLDED);
    for simulator in ["verilator", "iverilog"] {
        let report = cosim(dir.path(), &["--rounds", "1", "--simulator", simulator]);
        assert!(report["mismatch"].is_null(), "{report}");
        assert_eq!(report["grid"], serde_json::json!([2, 1]), "one lane, two slots");
        // Most outputs are valid at few clocks only, and are compared at these clocks.
        let (clocks, compared) = (report["clocks"].as_u64(), report["comparisons"].as_u64());
        assert!(compared > clocks.map(|clocks| 7 * clocks), "{report}");
        assert!(compared < clocks.map(|clocks| 9 * clocks), "{report}");
    }
    let array = ["--level", "rcm", "--grid", "3x1", "--simulator", "iverilog"];
    assert!(cosim(dir.path(), &array)["mismatch"].is_null());
    let frame = "[frame]\nwidth = 10\nheight = 8\n";
    write_config(dir.path(), &format!("{frame}{FOLDED}feed = \"raster\"\n"));
    let report = cosim(dir.path(), &["--full", "--simulator", "iverilog", "scene:street"]);
    assert!(report["mismatch"].is_null(), "{report}");
    assert_eq!(report["grid"], serde_json::json!([3, 2]));
    let names: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(names, ["camera.toml"], "a good run leaves nothing");
}

/// This test uses real images, if the environment variable FOVEATE_DATA names their folder.
#[test]
fn real_images_agree() {
    let Some(data) = data_folder() else { return };
    if !require_tools(SIMULATORS) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_config(dir.path(), "[hardware]\norganization = \"serial\"\n");
    let folder = data.join("mosquito/culex");
    let array = ["--level", "rcm", "--grid", "4x3", "--rounds", "0"];
    let report = cosim(dir.path(), &[&[folder.to_str().unwrap()], &array[..]].concat());
    assert!(report["mismatch"].is_null(), "{report}");
    assert!(report["frames"].as_u64() > Some(1), "{report}");
}

#[test]
#[ignore = "two simulators are compiled; scripts/release.sh whole runs it"]
fn edited_serial_verilog_is_caught_and_replayed() {
    if !require_tools(SIMULATORS) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_config(dir.path(), FOLDED);
    run_successfully(dir.path(), &["generate", "--config", "camera.toml", "-o", "core"]);
    let file = dir.path().join("core/rtl/serial_decision.v");
    let text = fs::read_to_string(&file).unwrap();
    assert_eq!(text.matches("score_o >= minimum").count(), 1);
    fs::write(&file, text.replace("score_o >= minimum", "score_o > minimum")).unwrap();
    for simulator in ["verilator", "iverilog"] {
        let args = ["cosim", "--config", "camera.toml", "--rtl", "core/rtl", "--rounds", "1"];
        let outcome = run_in(
            dir.path(),
            &[&args[..], &["--junit", "c.xml", "--simulator", simulator]].concat(),
        );
        assert_eq!(outcome.code, 1, "{}", outcome.stderr);
        // The report may break a line anywhere between words.
        let report = outcome.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in ["expected 'h1", "phase \"rotate edge\"", "clock "] {
            assert!(report.contains(part), "{part}: {}", outcome.stdout);
        }
        let junit = fs::read_to_string(dir.path().join("c.xml")).unwrap();
        assert!(junit.contains("<failure"), "{junit}");
        let replay = dir.path().join("foveate-replay");
        let again = |simulator: &str| {
            Command::new(replay.join("replay.sh")).arg(simulator).output().unwrap()
        };
        for replayed in ["verilator", "iverilog"] {
            let again = again(replayed);
            let log = String::from_utf8_lossy(&again.stdout).into_owned();
            assert_eq!(again.status.code(), Some(1), "{simulator} {replayed}: {log}");
        }
        // The replay passes after the fault is corrected in its files.
        let broken = replay.join("rtl/serial_decision.v");
        let text = fs::read_to_string(&broken).unwrap();
        fs::write(&broken, text.replace("score_o > minimum", "score_o >= minimum")).unwrap();
        assert_eq!(again("iverilog").status.code(), Some(0), "{simulator}");
        // The next run would not replace a replay folder that was edited.
        fs::remove_dir_all(&replay).unwrap();
    }
}
