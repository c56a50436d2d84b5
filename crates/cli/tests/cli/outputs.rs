// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the optional outputs of `simulate`, and of `explain`, end to end.

use std::fs;
use std::path::Path;

use crate::common::{files_below, foveate, run_successfully};
use foveate_tools::{Tool, testing::require_tools};
use serde_json::Value;

const SMALL: [&str; 5] = ["scene:street", "--frames", "4", "--set", "frame={width=64,height=48}"];

fn simulate<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["simulate", "-o", "out"], &SMALL[..], more].concat()
}

fn has(folder: &Path, name: &str) -> bool {
    folder.join("out").join(name).exists()
}

#[test]
fn every_option_writes_its_files_and_no_others() {
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &simulate(&[]));
    let plain = files_below(&dir.path().join("out")).len();
    for (options, files) in [
        (&["--events", "csv"][..], &["events.csv"][..]),
        (&["--events", "parquet,csv", "--only", "active"], &["events.csv", "events.parquet"]),
        (&["--pixel-events"], &["pixel_events.npz"]),
        (&["--pixel-events=csv,npz", "--log"], &["pixel_events.csv", "pixel_events.npz"]),
        (&["--pixel-events=evt2,evt3"], &["pixel_events_evt2.raw", "pixel_events_evt3.raw"]),
        (&["--pixel-events=aedat4"], &["pixel_events.aedat4"]),
        (&["--pixel-events=csv", "--contrast", "2.5"], &["pixel_events.csv"]),
    ] {
        run_successfully(dir.path(), &[&simulate(options)[..], &["--force"]].concat());
        assert_eq!(files_below(&dir.path().join("out")).len(), plain + files.len(), "{options:?}");
        assert!(files.iter().all(|name| has(dir.path(), name)), "{options:?}");
    }
    let pictures = ["--overlay", "--heatmap", "--rendered", "none", "--force"];
    run_successfully(dir.path(), &simulate(&pictures));
    assert!(!has(dir.path(), "rendered"));
    for name in ["overlay/000003.png", "heatmap_edge/000003.png", "heatmap_temporal/000000.png"] {
        assert!(has(dir.path(), name), "{name}");
    }
    let overlay = || fs::read(dir.path().join("out/overlay/000003.png")).unwrap();
    let sent = overlay();
    run_successfully(dir.path(), &simulate(&["--overlay-outlines", "--force"]));
    assert_ne!(overlay(), sent);
}

#[test]
fn the_summary_compares_the_cameras() {
    let dir = tempfile::tempdir().unwrap();
    let text = run_successfully(dir.path(), &simulate(&["--pixel-events=csv"]));
    let summary = fs::read_to_string(dir.path().join("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let csv = fs::read_to_string(dir.path().join("out/pixel_events.csv")).unwrap();
    let events = csv.lines().count() - 1;
    assert_eq!(summary["bandwidth"]["pixel"]["events"], events);
    assert_eq!(summary["bandwidth"]["pixel"]["bytes"], 4 * events);
    assert_eq!(summary["bandwidth"]["raw"]["bytes"], 4 * 64 * 48);
    for (name, key) in
        [("raw video", "raw"), ("region camera", "region"), ("pixel events", "pixel")]
    {
        let line = text.lines().find(|line| line.starts_with(name)).unwrap();
        let bytes = format!(" {} bytes (", summary["bandwidth"][key]["bytes"]);
        assert!(line.contains(&bytes), "{line} {bytes}");
    }
}

/// The message of an ffmpeg that fails is quoted, and no folder is left.
#[cfg(unix)]
#[test]
fn a_failing_ffmpeg_is_quoted() {
    use std::os::unix::fs::PermissionsExt;
    let dir = tempfile::tempdir().unwrap();
    let stub = tempfile::tempdir().unwrap();
    let ffmpeg = stub.path().join("ffmpeg");
    for then in ["exit 1", "cat > /dev/null; exit 1"] {
        let script = format!(
            "#!/bin/sh\n[ \"$1\" = -version ] && echo 'ffmpeg version 6.0' && exit 0\n\
             echo 'Unknown encoder' >&2\n{then}\n"
        );
        fs::write(&ffmpeg, script).unwrap();
        fs::set_permissions(&ffmpeg, fs::Permissions::from_mode(0o755)).unwrap();
        let output = foveate(&simulate(&["--rendered", "mkv"]))
            .current_dir(dir.path())
            .env("FOVEATE_FFMPEG", &ffmpeg)
            .output()
            .unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(3), "{stderr}");
        assert!(stderr.contains("Unknown encoder") && stderr.contains("rendered.mkv"), "{stderr}");
        assert!(fs::read_dir(dir.path()).unwrap().next().is_none(), "nothing is left");
    }
}

#[test]
fn video_is_one_file() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &simulate(&["--rendered", "video", "--overlay=mp4"]));
    assert!(has(dir.path(), "rendered.mkv") && has(dir.path(), "overlay.mp4"));
    assert!(!has(dir.path(), "rendered") && !has(dir.path(), "overlay"));
}

#[test]
fn explain_says_why_in_text_and_json() {
    let dir = tempfile::tempdir().unwrap();
    let args = ["explain", "scene:street", "--frame", "2", "--region", "3,4"];
    let args = [&args[..], &["--set", "frame={width=64,height=48}"]].concat();
    let text = run_successfully(dir.path(), &args);
    let told: Value =
        serde_json::from_str(&run_successfully(dir.path(), &[&args[..], &["--json"]].concat()))
            .unwrap();
    assert_eq!((&told["frame"], &told["region"]["x0"]), (&2.into(), &24.into()));
    assert_eq!(told["raw"].as_array().unwrap().len(), 8);
    let rule = told["rule"].as_str().unwrap().split(": ").next().unwrap().to_owned();
    assert!(text.contains(&format!("decision  {rule}")), "{text}");
    // The table of `simulate` has the same values for this region.
    run_successfully(dir.path(), &simulate(&["--events", "csv"]));
    let table = fs::read_to_string(dir.path().join("out/events.csv")).unwrap();
    let row = table.lines().find(|line| line.starts_with("2,66667,3,4,24,32,")).unwrap();
    let bit = |key: &str| u8::from(told[key].as_bool().unwrap());
    let expected = format!(
        "{},{},{},{},{}",
        bit("srs"),
        bit("trs"),
        told["spatial"][0]["score"],
        told["temporal"]["count"],
        told["action"].as_str().unwrap()
    );
    assert!(row.ends_with(&expected), "{row} {expected}");
}
