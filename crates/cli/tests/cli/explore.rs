// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `foveate explore` and `foveate fit`, end to end.

use std::fs;
use std::path::Path;

use crate::common::{files_below, run_in, run_successfully};
use foveate_tools::{
    Tool,
    testing::{require_tools, takes_whole_lists},
};

const SPACE: &str = "method = 'each'\n[design]\nframe.width = 64\nframe.height = 48\n[ideal]\n\
     region.neighborhood = 'shared'\n[vary]\nframe.pixel_bits = [6, 4]\nregion.neighborhood = ['shared']\n\
     hardware.fold = [2]\n";

const RUN: [&str; 8] =
    ["explore", "space.toml", "scene:street", "-o", "out", "--frames", "6", "--no-area"];

fn folder_with_space() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("space.toml"), SPACE).unwrap();
    dir
}

#[test]
fn a_space_becomes_a_folder_and_a_rerun_gives_the_same() {
    let dir = folder_with_space();
    let printed = run_successfully(dir.path(), &RUN);
    assert!(printed.starts_with("4 designs"), "{printed}");
    assert!(
        printed.contains("1 combination cannot be built, for example hardware.fold = 2: "),
        "{printed}"
    );
    let before = files_below(&dir.path().join("out"));
    let names: Vec<String> =
        before.iter().filter_map(|(path, _)| path.to_str().map(str::to_owned)).collect();
    for name in ["report.html", "points.csv", "points.parquet", "clips.csv", "designs/1.toml"] {
        assert!(names.iter().any(|path| path.ends_with(name)), "{name} in {names:?}");
    }
    run_successfully(dir.path(), &RUN);
    assert_eq!(files_below(&dir.path().join("out")), before);
    let json = run_successfully(dir.path(), &[&RUN[..], &["--json"]].concat());
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["rows"][3]["figures"]["action_flips"], 0.0);
    // Nothing is synthesized, so that no clock is known unless the space gives one.
    assert!(json["rows"][3]["speed"].is_null() && json["clock_mhz"].is_null(), "{json}");
    fs::write(dir.path().join("space.toml"), format!("clock_mhz = 50\n{SPACE}")).unwrap();
    let given = run_successfully(dir.path(), &[&RUN[..], &["--json"]].concat());
    let given: serde_json::Value = serde_json::from_str(&given).unwrap();
    let row = &given["rows"][0];
    let rate = 50e6 / row["clocks_per_frame"].as_f64().unwrap();
    assert_eq!(
        (&row["speed"]["frames_per_second"], &row["speed"]["estimated"]),
        (&rate.into(), &false.into())
    );
    fs::write(dir.path().join("space.toml"), SPACE).unwrap();
    let markdown = run_successfully(dir.path(), &[&RUN[..], &["--markdown"]].concat());
    assert!(markdown.contains("| frame.pixel_bits = 6 |"), "{markdown}");
    run_successfully(dir.path(), &["check", "out/designs/2.toml"]);
}

#[test]
fn the_page_carries_every_configuration_and_loads_nothing() {
    let dir = folder_with_space();
    run_successfully(dir.path(), &RUN);
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("<svg"));
    assert!(page.matches("pixel_bits = 4").count() > 0);
    for outside in ["src=\"http", "href=\"http", "@import", "url(http"] {
        assert!(!page.contains(outside), "{outside}");
    }
}

#[test]
fn what_fit_finds_can_be_generated() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let frame = ["--set", "frame={width=32,height=24}", "--frames", "120", "--quiet"];
    let fit_within = |limits: &[&str], more: &[&str]| {
        let fit = ["fit", "scene:street", "-o", "found.toml", "--max-syntheses", "1"];
        run_in(dir.path(), &[&fit, &frame[..], limits, more].concat())
    };
    // Twelve regions are too seldom active for a limit on missed regions or false alarms.
    let fit =
        |more: &[&str]| fit_within(&["--max-missed", "100%", "--max-false-alarms", "100%"], more);
    let undecided = fit_within(&[], &[]);
    assert_eq!(undecided.code, 1, "{}", undecided.stdout);
    for part in ["undecided", "--max-missed needs at least 49", "use more frames"] {
        assert!(undecided.stderr.contains(part), "{part}: {}", undecided.stderr);
    }
    let found = fit(&["--max-flips", "0%", "--min-fps", "100", "--clock", "1MHz"]);
    assert_eq!(found.code, 0, "{}{}", found.stdout, found.stderr);
    assert!(found.stdout.contains("Cheapest: serial"), "{}", found.stdout);
    let text = found.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains(" frames/s at 1 MHz") && text.contains(" at 1 MHz (at least 100)"),
        "{text}"
    );
    for part in ["fitted: ", "held out: ", "Why:", "found.toml. To build it: "] {
        assert!(found.stdout.contains(part), "{part} in {}", found.stdout);
    }
    assert_eq!(fit(&["--min-recall", "90%"]).code, 2, "without boxes");
    run_successfully(dir.path(), &["generate", "--config", "found.toml", "-o", "core"]);
    assert!(Path::new(&dir.path().join("core/rtl/rcm.v")).exists());
    if !takes_whole_lists() {
        return;
    }
    let limits = ["--max-flips", "0%", "--min-fps", "100", "--clock", "1MHz", "--max-lut", "2"];
    let none = fit(&limits);
    assert_eq!(none.code, 1, "{}", none.stdout);
    assert!(none.stdout.contains("Binding: without --max-lut"), "{}", none.stdout);
    assert!(none.stderr.contains("no design meets all limits"), "{}", none.stderr);
    // The ground truth is an object in the lower left corner, which changes now and then.
    let rows = (1..=120).map(|frame| format!("{frame},1,1,17,8,8,1,1,1\n"));
    fs::write(dir.path().join("gt.txt"), rows.collect::<String>()).unwrap();
    let lost = fit(&["--max-flips", "0%", "--boxes", "gt.txt", "--min-recall", "90%"]);
    assert_eq!(lost.code, 1, "{}", lost.stdout);
    assert!(lost.stdout.contains("NOT objects sent by half "), "{}", lost.stdout);
    let text = lost.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains(" frames/s at an estimated clock of "), "{text}");
    assert!(lost.stdout.contains("Binding: without --min-recall"), "{}", lost.stdout);
    assert_eq!(fit(&["--boxes", "gt.txt"]).code, 2, "without a limit");
}
