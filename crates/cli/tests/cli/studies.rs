// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `foveate analyze`, end to end.

use crate::common::{files_below, run_successfully};

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
        let printed = run_successfully(dir.path(), &analyze(study, &["--force"]));
        assert!(printed.starts_with(&format!("out: {study}.csv, {study}")), "{printed}");
        // The additional file is the list of the files.
        assert_eq!(files_below(&dir.path().join("out")).len(), files + 1, "{study}");
    }
    let json = run_successfully(dir.path(), &analyze("temporal", &["--force", "--json"]));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["study"], "temporal");
    assert_eq!(json["rows"][1][0], "shake");
}

/// The number of objects stands below the bars of their shares.
#[test]
fn a_chart_of_recall_counts_its_objects() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("a.txt"), "1,5,9,9,32,24,1,1,1\n2,5,9,9,32,24,1,1,1\n").unwrap();
    std::fs::write(dir.path().join("b.txt"), "2,1,9,9,8,8,1,1,1\n").unwrap();
    run_successfully(dir.path(), &analyze("recall", &["--boxes", "a.txt", "--boxes", "b.txt"]));
    let chart = std::fs::read_to_string(dir.path().join("out/recall-size.svg")).unwrap();
    // The first frame of a clip does not count.
    assert!(chart.contains("\nsmall (n = 2)\n"), "{chart}");
}
