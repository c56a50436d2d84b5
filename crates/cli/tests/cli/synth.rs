// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the scripts of a core that place and route it. They must give the clock that `estimate`
//! prints.

use std::path::Path;
use std::process::Command;

use crate::common::run_successfully;
use foveate_tools::{Tool, Toolchain, testing::require_tools};
use serde_json::Value;

/// Returns the slowest clock that a script prints for several seeds.
fn slowest_clock(core: &Path, script: &str, words: &[&str], nextpnr: Tool) -> f64 {
    let program = |tool| Toolchain::system().find(tool).unwrap().path;
    let mut command = Command::new("sh");
    command.arg(script).args(words).current_dir(core);
    command.env("YOSYS", program(Tool::Yosys)).env("NEXTPNR", program(nextpnr));
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    let (_, rest) = text.split_once(": worst ").unwrap_or_else(|| panic!("{text}"));
    rest.split(' ').next().unwrap().parse().unwrap()
}

/// The allowed difference of the clocks. The netlists differ only in the names of the registers at
/// the ports, and so their clocks differ as those of two seeds do.
const TOLERANCE: f64 = 0.15;

#[test]
#[ignore = "half a minute of synthesis and routing; scripts/release.sh whole runs it"]
fn the_scripts_of_a_core_give_the_clock_of_the_estimate() {
    if !require_tools(&[Tool::Yosys, Tool::NextpnrIce40, Tool::NextpnrEcp5]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let settings = [
        "--preset",
        "raster",
        "--set",
        "region.size=4",
        "--set",
        "frame={width=16,height=12}",
        "--set",
        "denoise.filter='none'",
    ];
    run_successfully(
        dir.path(),
        &[&["generate", "-o", "core", "--prefix", "cam0"], &settings[..]].concat(),
    );
    for (script, device, nextpnr, seeds) in [
        ("synth/ecp5.sh", "ecp5-25k", Tool::NextpnrEcp5, "1"),
        ("synth/ice40.sh", "hx8k", Tool::NextpnrIce40, "2"),
    ] {
        let estimate =
            ["estimate", "--level", "rcm", "--place-and-route", device, "--seeds", seeds, "--json"];
        let report: Value = serde_json::from_str(&run_successfully(
            dir.path(),
            &[&estimate[..], &settings].concat(),
        ))
        .unwrap();
        let fmax = &report["devices"][0]["placed"]["fmax"];
        let reached = fmax["seeds_mhz"].as_array().unwrap_or_else(|| panic!("{report}"));
        let expected = reached.iter().filter_map(Value::as_f64).fold(f64::INFINITY, f64::min);
        let found =
            slowest_clock(&dir.path().join("core"), script, &["rcm", device, seeds], nextpnr);
        assert!((found / expected - 1.0).abs() < TOLERANCE, "{device}: {found} and {expected} MHz");
    }
    for (words, part) in [
        (&["rom"][..], "unknown module"),
        (&["rcm", "ecp6"], "unknown device"),
        (&["rcm", "ecp5-25k", "0"], "seeds"),
    ] {
        let mut command = Command::new("sh");
        let output =
            command.arg("core/synth/ecp5.sh").args(words).current_dir(dir.path()).output().unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && text.contains(part), "{words:?}: {text}");
    }
}
