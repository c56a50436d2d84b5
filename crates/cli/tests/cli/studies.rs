// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `foveate analyze`, end to end.

use crate::common::{expect_failure, files_below, run_successfully};

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

#[test]
fn recall_prints_objects_and_writes_everything() {
    let dir = tempfile::tempdir().unwrap();
    let rows = (1..=4).map(|frame| format!("{frame},5,9,9,32,24,1,1,1\n{frame},6,1,1,3,3,0,1,1\n"));
    for (name, text) in
        [("a.txt", rows.collect::<String>()), ("b.txt", "2,1,9,9,8,8,1,1,1\n".to_owned())]
    {
        std::fs::write(dir.path().join(name), text).unwrap();
    }
    let boxes = ["--boxes", "a.txt", "--boxes", "b.txt"];
    let printed = run_successfully(dir.path(), &analyze("recall", &boxes));
    assert!(printed.starts_with("out: recall.csv, recall-tracks.csv, recall.svg"), "{printed}");
    for row in ["| street | all | 3 |", "| shake | all | 1 |", "| all clips | all | 4 |"] {
        assert!(printed.contains(row), "{row}: {printed}");
    }
    // The number of objects stands below the bars of their shares.
    let chart = std::fs::read_to_string(dir.path().join("out/recall-size.svg")).unwrap();
    assert!(chart.contains("\nsmall (n = 4)\n"), "{chart}");
    let json = run_successfully(
        dir.path(),
        &analyze("recall", &[&boxes[..], &["--json", "--force"]].concat()),
    );
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["columns"][6], "objects");
    assert_eq!(json["rows"][0][6], "3");
    let known = [("recall", "--boxes"), ("temporal", "--boxes is only for the study recall")];
    for ((study, part), boxes) in known.into_iter().zip([&[][..], &boxes]) {
        expect_failure(dir.path(), 2, &analyze(study, &[&["--force"], boxes].concat()), &[part]);
    }
    std::fs::write(dir.path().join("b.txt"), "2,1,9,9,8,8,1,1,1\n3,1,9,9,8\n").unwrap();
    expect_failure(
        dir.path(),
        2,
        &analyze("recall", &[&boxes[..], &["--force"]].concat()),
        &["b.txt", "line 2"],
    );
}

#[test]
fn mistakes_are_one_line_and_leave_what_is_there() {
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &analyze("temporal", &[]));
    let before = files_below(dir.path());
    expect_failure(dir.path(), 2, &analyze("size", &[]), &["out", "--force"]);
    expect_failure(dir.path(), 2, &analyze("sensor", &["--force"]), &["--sensor-events"]);
    expect_failure(dir.path(), 2, &["analyze", "size", "nowhere.mp4", "-o", "x"], &["nowhere.mp4"]);
    expect_failure(
        dir.path(),
        2,
        &analyze("size", &["--force", "--set", "region.size=1"]),
        &["region.size"],
    );
    assert_eq!(files_below(dir.path()), before);
}
