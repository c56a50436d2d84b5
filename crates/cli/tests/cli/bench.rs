// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `bench`, end to end, with the tools and without.

use crate::common::{foveate, run_successfully};
use foveate_tools::{Tool, testing::require_tools};
use serde_json::Value;

const TINY: [&str; 5] = ["bench", "--set", "frame={width=16,height=16}", "--seconds", "0.01"];

/// Runs `bench` on four regions and returns its rows, by level.
fn rows(extra: &[&str]) -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let args = [&TINY[..], &["--json"], extra].concat();
    let report: Value = serde_json::from_str(&run_successfully(dir.path(), &args)).unwrap();
    assert_eq!(report["format_version"], 2);
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0, "nothing is left");
    report["rows"].as_array().unwrap().clone()
}

fn assert_agrees(row: &Value) {
    let measured = &row["measured"];
    assert_eq!(measured["differing"], 0, "{row}");
    assert!(measured["frames_per_second"].as_f64().unwrap() > 0.0, "{row}");
    let is_compared = measured["compared"].as_u64().unwrap() > 100;
    assert!(is_compared || row["level"] == "functional-clear", "{row}");
}

fn levels(rows: &[Value]) -> Vec<&str> {
    rows.iter().map(|row| row["level"].as_str().unwrap()).collect()
}

#[test]
#[ignore = "four simulators and a netlist are made; scripts/release.sh whole runs it"]
fn every_level_of_every_organization_agrees() {
    let needed = [Tool::Verilator, Tool::Cxx, Tool::Yosys, Tool::Iverilog, Tool::Vvp];
    if !require_tools(&needed) {
        return;
    }
    let pipelined = rows(&["--netlist", "--frames", "2"]);
    pipelined.iter().for_each(assert_agrees);
    let all = ["functional-clear", "functional-fast", "transactions", "cycle", "rtl", "netlist"];
    assert_eq!(levels(&pipelined), all);
    let levels_with_rtl = &all[..5];
    let rtl = &pipelined[4]["measured"];
    assert_eq!(rtl["times_rtl"], 1.0);
    assert!(rtl["files_clocks_per_second"].as_f64().unwrap() > 0.0, "{rtl}");
    assert!(pipelined[3]["measured"]["times_rtl"].as_f64().unwrap() > 0.0);

    // Every level follows the same map: a region that is off, one that is keen, and one that is always
    // relevant.
    let zones = "zones={classes=['12', '30'], keen={temporal={level=3}}}";
    let zoned = rows(&["--set", zones, "--frames", "2"]);
    zoned.iter().for_each(assert_agrees);
    assert_eq!(levels(&zoned), levels_with_rtl);

    let raster = ["--set", "hardware.organization='raster'", "--set", "frame={width=40,height=40}"];
    let raster = rows(&[&raster[..], &["--frames", "2"]].concat());
    raster.iter().for_each(assert_agrees);
    assert_eq!(levels(&raster), levels_with_rtl);

    let serial = rows(&["--preset", "serial", "scene:street", "--frames", "2"]);
    serial.iter().for_each(assert_agrees);
    assert_eq!(levels(&serial), levels_with_rtl);
}

#[test]
fn a_level_without_its_tool_says_so() {
    let dir = tempfile::tempdir().unwrap();
    for (extra, width) in [(&[][..], "120"), (&[], "44"), (&["--markdown"], "80")] {
        let output = foveate(&[&TINY[..], &["--netlist"], extra].concat())
            .env("PATH", dir.path())
            .env("COLUMNS", width)
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(0), "{text}");
        for part in ["PipelinedRcm", "RTL", "apt-get install verilator", "apt-get install yosys"] {
            let flowed = text.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(flowed.contains(part), "{text}");
        }
        let columns: usize = width.parse().unwrap();
        let fits = text.lines().all(|line| line.chars().count() <= columns);
        assert!(fits || !extra.is_empty(), "{text}");
    }
}

/// An interrupt stops the compiler or the simulation, and leaves no folder behind.
#[cfg(unix)]
#[test]
fn ctrl_c_stops_it() {
    let dir = tempfile::tempdir().unwrap();
    let mut child = crate::common::foveate_with_signals()
        .args(["bench", "--frames", "2", "--seconds", "600"])
        .env("FOVEATE_CACHE", "off")
        .env("TMPDIR", dir.path())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_secs(1));
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}
