// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate fit --liberty`: the cheapest design in the cells of a process.

use std::path::Path;

use serde_json::Value;

use crate::common::silicon::{is_ready, number, write_long_clip};
use crate::common::{run_in, run_successfully};

/// A small task, of which few designs are synthesized. Its clip has too few active regions for limits on
/// missed regions and false alarms.
const TASK: [&str; 6] = [
    "clip",
    "--set",
    "region.size=4",
    "--max-flips=20%",
    "--max-missed=100%",
    "--max-false-alarms=100%",
];
/// Fits a design to the clip. Returns the result and the exit code.
fn fit(folder: &Path, args: &[&str]) -> (Value, i32) {
    let command = [&["fit", "--json", "--quiet", "-o", "design.toml"], &TASK[..], args];
    let run = run_in(folder, &command.concat());
    let result = serde_json::from_str(&run.stdout);
    (result.unwrap_or_else(|error| panic!("{error}: {}", run.stderr)), run.code)
}

/// Returns the constraint of that name on the first halves and on the second halves.
fn checks<'a>(found: &'a Value, name: &str) -> [&'a Value; 2] {
    ["fitted_held", "held_out_held"].map(|half| {
        let checks = found["design"][half].as_array().unwrap();
        checks.iter().find(|check| check["name"] == name).unwrap_or_else(|| panic!("{found}"))
    })
}

/// The figures are those that `estimate` has for the same design on the first half of the clip.
#[test]
fn the_cheapest_design_in_a_process_has_the_figures_of_estimate() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_long_clip(dir.path());
    let (found, code) = fit(
        dir.path(),
        &[
            "--cheapest",
            "energy",
            "--max-mw",
            "50",
            "--max-mm2",
            "50",
            "--max-syntheses",
            "1",
            "--liberty",
        ],
    );
    assert_eq!(code, 0, "{found}");
    let estimate = ["estimate", "--json", "--quiet", "--config", "design.toml", "--liberty"];
    let activity = ["--activity", "clip", "--max-frames", "40"];
    let report = run_successfully(dir.path(), &[&estimate[..], &activity].concat());
    let report: Value = serde_json::from_str(&report).unwrap();
    let process = &found["design"]["process"];
    let equal = |one: f64, other: f64| assert!((one - other).abs() <= 1e-9 * one, "{one} {other}");
    equal(number(process, "/unit_um2"), number(&report, "/unit/cells/area_um2"));
    equal(number(process, "/mm2"), number(&report, "/array/area_um2") / 1e6);
    equal(
        number(process, "/energy/usual_mw"),
        number(&report, "/energy/stretches/1/stopped_clock_mw"),
    );
    // The stretch that sends the most regions need not take the most power.
    let stretches = [0, 1, 2].map(|at| format!("/energy/stretches/{at}/stopped_clock_mw"));
    let most = stretches.iter().map(|stretch| number(&report, stretch)).fold(0.0, f64::max);
    equal(number(process, "/energy/busiest_mw"), most);
    let parts = ["clock", "memory", "flip_flops", "logic"];
    let parts = parts.map(|part| format!("/energy/stretches/1/region_nj_per_frame/{part}"));
    let sum: f64 = parts.iter().map(|part| number(&report, part)).sum();
    equal(number(process, "/energy/nj_per_region"), sum);
    let slack = number(&report, "/path/mhz") - number(process, "/clock_mhz");
    assert!((0.0..0.1).contains(&slack), "{slack}");
    // The clock of the process is the clock of the design.
    assert_eq!(found["design"]["speed"]["clock_mhz"], process["clock_mhz"]);
    let [fitted, held_out] = checks(&found, "max-mw");
    assert_eq!(fitted["value"], process["energy"]["busiest_mw"]);
    assert_eq!(held_out["value"], found["design"]["held_out_energy"]["busiest_mw"]);
    assert_ne!(fitted["value"], held_out["value"], "they are of different frames");
    assert_eq!(checks(&found, "max-mm2").map(|check| &check["value"]), [&process["mm2"]; 2]);
}

/// A lane is smaller than the RPUs of its regions, and takes more energy, because it needs more clocks.
#[test]
#[ignore = "half a minute of synthesis; scripts/release.sh whole runs it"]
fn the_cheapest_design_is_that_of_the_wanted_cost() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_long_clip(dir.path());
    let costs = |(cheapest, syntheses)| {
        let most = ["--max-syntheses", syntheses];
        let (found, _) =
            fit(dir.path(), &[&["--cheapest", cheapest][..], &most, &["--liberty"]].concat());
        assert_eq!(
            (&found["feasible"], &found["cheapest"]),
            (&Value::Bool(true), &cheapest.into())
        );
        let process = &found["design"]["process"];
        [number(process, "/mm2"), number(process, "/energy/usual_mw")]
    };
    let [smallest, coolest] = [("mm2", "3"), ("energy", "1")].map(costs);
    assert!(smallest[0] < coolest[0] && coolest[1] < smallest[1], "{smallest:?} {coolest:?}");
}

/// A lane keeps its regions in a memory, which is neither flip-flops nor a macro here. No clock is above the
/// highest one of the cells.
#[test]
#[ignore = "half a minute of synthesis; scripts/release.sh whole runs it"]
fn a_design_with_a_large_memory_has_no_energy_and_no_clock_beyond_its_cells() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_long_clip(dir.path());
    let args = ["--max-syntheses", "2", "--clock", "9GHz", "--memory-limit", "190", "--liberty"];
    let (found, _) = fit(dir.path(), &args);
    let design = &found["design"];
    assert!(design["toml"].as_str().unwrap().contains("\"serial\""), "{found}");
    assert_eq!(found["feasible"], Value::Bool(true));
    let process = &design["process"];
    assert_eq!((&process["energy"], &process["mm2"]), (&Value::Null, &Value::Null));
    assert_eq!(design.get("held_out_energy"), None);
    assert!(number(process, "/memory_bits_without_macro") > 190.0);
    assert_eq!(design["speed"]["clock_mhz"], process["clock_mhz"]);
    // A power that is not known exceeds its limit, once.
    let limited = [&args[..], &["--max-mw", "50"]].concat();
    let (found, _) = fit(dir.path(), &limited);
    let checks = found["design"]["fitted_held"].as_array().unwrap();
    assert_eq!(checks.iter().filter(|check| check["name"] == "max-mw").count(), 1, "{found}");
}

#[test]
#[ignore = "half a minute of synthesis; scripts/release.sh whole runs it"]
fn limits_of_a_process_can_be_binding() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_long_clip(dir.path());
    let limits = [("max-mw", "0.000001", "energy"), ("max-mm2", "0.001", "mm2")];
    for (option, limit, cheapest) in limits {
        let limited = format!("--{option}={limit}");
        let args = ["--cheapest", cheapest, &limited, "--max-syntheses", "1", "--liberty"];
        let (found, code) = fit(dir.path(), &args);
        assert_eq!((code, &found["feasible"]), (1, &Value::Bool(false)), "{found}");
        assert_eq!(found["binding"], serde_json::json!([option]));
        let [fitted, held_out] = checks(&found, option);
        assert_eq!(
            (&fitted["holds"], &held_out["holds"]),
            (&Value::Bool(false), &Value::Bool(false))
        );
        let value = number(fitted, "/value");
        assert!(value > limit.parse().unwrap(), "{value}");
    }
}
