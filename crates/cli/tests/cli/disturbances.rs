// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate stress` with a design and a clip, and `--disturb` of `explore`.

use std::fs;

use serde_json::Value;

use crate::common::run_successfully;

const DESIGN: [&str; 4] = ["--preset", "bare", "--set", "region.neighborhood='shared'"];
const CLIP: [&str; 7] =
    ["scene:street", "--frames", "24", "--set", "frame={width=96,height=64}", "--quiet", "--json"];

#[test]
fn a_design_is_compared_with_the_ideal_of_the_clip_as_it_is() {
    let dir = tempfile::tempdir().unwrap();
    let task = run_successfully(dir.path(), &["presets", "bare"]);
    fs::write(dir.path().join("task.toml"), task).unwrap();
    let report = run_successfully(
        dir.path(),
        &[&["stress", "--task", "task.toml"], &DESIGN[..], &CLIP].concat(),
    );
    let report: Value = serde_json::from_str(&report).unwrap();
    let rows = report["rows"].as_array().unwrap();
    let row = |name: &str| {
        let found = rows.iter().find(|row| row["disturbance"] == name);
        found.unwrap_or_else(|| panic!("{name}: {report}"))
    };
    let figure = |name: &str, figure: &str| row(name)[figure].as_f64().unwrap();
    assert_eq!(rows.len(), 10);
    // The design is the task, so only the disturbances make it differ.
    for key in ["flips", "missed", "false_alarms"] {
        assert_eq!((figure("none", key), figure("still=0", key)), (0.0, 0.0), "{key}");
    }
    assert_eq!(row("none")["psnr_ideal"], Value::Null);
    assert!(figure("noise=8", "flips") > figure("noise=3", "flips"));
    assert!(figure("noise=8", "false_alarms") > 0.5);
    assert!(figure("still=0", "bytes_per_frame") < figure("none", "bytes_per_frame"));
    // Nothing is active in a still picture, so false alarms are a share of all regions.
    assert!((0.0..0.5).contains(&figure("still=3", "false_alarms")));
    for name in ["jpeg=30", "flicker=8", "gain=50", "saturation=2", "shake=1"] {
        assert!(figure(name, "flips") > 0.0, "{name}");
    }
    let other = run_successfully(dir.path(), &[&["stress"], &DESIGN[..], &CLIP].concat());
    let other: Value = serde_json::from_str(&other).unwrap();
    assert!(other["rows"][0]["flips"].as_f64().unwrap() > 0.0, "the task is preset paper");
}

/// The printed figures add up to the printed flips, and those of JSON to the flips. Here the sum of the rounded
/// shares is 0.01 % less than the rounded flips.
#[test]
fn the_sources_of_flips_add_up() {
    let dir = tempfile::tempdir().unwrap();
    let frame = "frame={width=96,height=64,pixel_bits=5}";
    let clip = ["scene:street", "--frames", "7", "--set", frame, "--quiet"];
    let design = ["stress", "--set", "spatial.0.level=11"];
    let run = |more: &[&str]| run_successfully(dir.path(), &[&design[..], &clip, more].concat());
    let report: Value = serde_json::from_str(&run(&["--json"])).unwrap();
    let sources = report["sources"].as_array().unwrap();
    let names: Vec<&str> = sources.iter().map(|row| row["source"].as_str().unwrap()).collect();
    let expected =
        ["windows", "filter", "bits", "thresholds", "fraction bits", "reference", "interaction"];
    assert_eq!(names, expected);
    let shares: Vec<f64> = sources.iter().map(|row| row["flips"].as_f64().unwrap()).collect();
    let flips = report["rows"][0]["flips"].as_f64().unwrap();
    assert!((shares.iter().sum::<f64>() - flips).abs() < 1e-12 && flips > 0.0, "{report}");
    // Preset paper has isolated windows and no mean, and the filter and reference are the task's.
    let is_other: Vec<bool> = shares[..6].iter().map(|share| *share != 0.0).collect();
    assert_eq!(is_other, [true, false, true, true, false, false], "{report}");
    for (more, separator) in [(&[][..], None), (&["--markdown"][..], Some("|"))] {
        let text = run(more);
        let printed: Vec<Vec<&str>> = text
            .lines()
            .map(|line| match separator {
                Some(separator) => line.split(separator).map(str::trim).skip(1).collect(),
                None => line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect(),
            })
            .collect();
        let cells = |name: &str| printed.iter().find(|cells| cells.first() == Some(&name)).unwrap();
        assert_eq!(cells("source")[1..3], ["flips %", "interval %"], "{text}");
        let hundredths = |name: &str| {
            let percent: f64 = cells(name)[1].parse().unwrap();
            (100.0 * percent).round()
        };
        let sum: f64 = expected.iter().map(|name| hundredths(name)).sum();
        assert_eq!(sum, hundredths("none"), "{text}");
        assert_eq!(cells("filter")[1..3], ["0.00", "0.00 to 0.00"], "{text}");
    }
    let other = run(&["--set", "region.size=16"]);
    assert!(
        other.contains("none  the thresholds of the task are for regions of 8x8 pixels"),
        "{other}"
    );
}

#[test]
fn an_exploration_of_disturbed_clips_measures_them_anew() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("space.toml"), "[vary]\nregion.neighborhood = ['shared']\n").unwrap();
    let flips = |more: &[&str]| {
        let explore = ["explore", "space.toml", "scene:street", "--frames", "12", "--no-area"];
        let args = [&explore[..], &["-o", "out", "--quiet", "--json"], more].concat();
        let found: Value = serde_json::from_str(&run_successfully(dir.path(), &args)).unwrap();
        let flips = found["rows"][0]["figures"]["action_flips"].as_f64().unwrap();
        (flips, found["disturbance"].clone())
    };
    let (own, none) = flips(&[]);
    let (noisy, name) = flips(&["--disturb", "noise=8"]);
    assert!(noisy > own + 0.05, "{own} {noisy}");
    assert_eq!((none, name), (Value::Null, "noise=8".into()));
    assert_eq!(flips(&[]).0, own, "stored results name the disturbance");
}
