// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bench that comes with a core, by the commands of the core's own README.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::succeed_in;
use foveate_toolchain::Tool;
use foveate_toolchain::testing::require_tools;

/// Runs the commands of the README, without Foveate, and returns what they print.
fn replay(core: &Path) -> String {
    let readme = fs::read_to_string(core.join("README.md")).unwrap();
    let commands: Vec<_> = readme.lines().filter_map(|line| line.strip_prefix("    ")).collect();
    assert_eq!(commands.len(), 2, "{readme}");
    let output =
        Command::new("sh").args(["-ec", &commands.join("\n")]).current_dir(core).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    text
}

/// Writes a core.
fn core(folder: &Path, settings: &[&str]) {
    let mut args = vec!["generate", "--preset", "bare", "--force", "-o", "core"];
    for setting in settings {
        args.extend(["--set", setting]);
    }
    succeed_in(folder, &args);
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
    assert_eq!(replay(&folder).trim(), "PASS 2000 clocks");
    edit(&folder.join("rtl/vote.v"), "score_i >= minimum_i", "score_i > minimum_i");
    let text = replay(&folder);
    assert!(text.contains("\nFAIL "), "{text}");
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
        &[serial],
        &[serial, "region.size=4", "hardware.fold=3", "hardware.feed='raster'"],
        &[
            serial,
            "hardware.fold=3",
            "hardware.thresholds='constant'",
            "denoise.filter='median3x3'",
        ],
    ];
    for settings in designs {
        core(dir.path(), settings);
        let text = replay(&folder);
        assert!(text.starts_with("PASS ") && text.lines().count() == 1, "{settings:?}: {text}");
    }
    // Every stage of a frame is in the vectors: votes, Table I, pixels that leave.
    let faults = [
        ("serial_decision", "score_o >= minimum", "score_o < minimum", "_o expected"),
        ("serial_sequencer", "KEPT_AT + position", "KEPT_AT + position + 1", "forward_pixel_o"),
    ];
    for (leaf, from, to, port) in faults {
        core(dir.path(), &[serial, "region.size=4", "hardware.fold=2"]);
        edit(&folder.join(format!("rtl/{leaf}.v")), from, to);
        let text = replay(&folder);
        assert!(text.contains("\nFAIL ") && text.contains(port), "{leaf}: {text}");
    }
}
