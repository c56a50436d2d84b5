// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate analyze`, end to end.

use crate::common::{fail_in, files_below, succeed_in};

const SCENES: [&str; 6] =
    ["scene:street", "scene:shake", "--frames", "4", "--set", "frame={width=64,height=48}"];

fn analyze<'a>(study: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["analyze", study, "-o", "out"], &SCENES[..], more].concat()
}

#[test]
fn every_study_of_scenes_writes_tables_and_charts() {
    let dir = tempfile::tempdir().unwrap();
    for (study, files) in [
        ("activity", 7),
        ("temporal", 3),
        ("redundancy", 3),
        ("mad-histogram", 3),
        ("size", 3),
        ("threshold", 7),
    ] {
        let printed = succeed_in(dir.path(), &analyze(study, &["--force"]));
        assert!(printed.starts_with(&format!("out: {study}.csv, {study}")), "{printed}");
        // One more is the list of them.
        assert_eq!(files_below(&dir.path().join("out")).len(), files + 1, "{study}");
    }
    let json = succeed_in(dir.path(), &analyze("temporal", &["--force", "--json"]));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["study"], "temporal");
    assert_eq!(json["rows"][1][0], "shake");
}

#[test]
fn mistakes_are_one_line_and_leave_what_is_there() {
    let dir = tempfile::tempdir().unwrap();
    succeed_in(dir.path(), &analyze("temporal", &[]));
    let before = files_below(dir.path());
    fail_in(dir.path(), 2, &analyze("size", &[]), &["out", "--force"]);
    fail_in(dir.path(), 2, &analyze("sensor", &["--force"]), &["--sensor-events"]);
    fail_in(dir.path(), 2, &["analyze", "size", "nowhere.mp4", "-o", "x"], &["nowhere.mp4"]);
    fail_in(
        dir.path(),
        2,
        &analyze("size", &["--force", "--set", "region.size=1"]),
        &["region.size"],
    );
    assert_eq!(files_below(dir.path()), before);
}
