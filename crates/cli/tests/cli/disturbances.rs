// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate stress` with a design and a clip, and `--disturb` of `explore`.

use std::fs;

use serde_json::Value;

use crate::common::{expect_failure, run_in, run_successfully};

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
    expect_failure(dir.path(), 2, &["stress", "--preset", "bare"], &["give an input"]);
    assert_eq!(run_in(dir.path(), &["stress", "scene:street", "--short"]).code, 2);
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
    let wrong = ["fit", "scene:street", "--disturb", "rain=3"];
    let refused = run_in(dir.path(), &wrong);
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("rain=3") && refused.stderr.contains("noise=LEVELS"));
    let network = ["fit", "scene:street", "--disturb", "noise=3", "--network", "a.onnx"];
    assert_eq!(run_in(dir.path(), &network).code, 2);
}
