// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `foveate explore --plan` and `--only`, end to end: units of work that several machines
//! do.

use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};

use serde_json::Value;

use crate::common::{expect_failure, files_below, foveate_with_signals, run_successfully};
use crate::full_disk::run_within;

const SPACE: &str = "[design]\nframe.width = 64\nframe.height = 48\n[vary]\nspatial.0.level = [70, 80, 90, 100]\n\
     frame.pixel_bits = [8, 7, 6, 5, 4]\n";

const RUN: [&str; 9] = [
    "explore",
    "space.toml",
    "scene:street",
    "scene:shake",
    "-o",
    "out",
    "--frames",
    "6",
    "--no-area",
];

fn explore(more: &[&str]) -> Vec<String> {
    RUN.iter().chain(more).map(|text| (*text).to_owned()).collect()
}

fn folder_with_space() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("space.toml"), SPACE).unwrap();
    dir
}

fn succeed(folder: &Path, more: &[&str]) -> String {
    let args = explore(more);
    run_successfully(folder, &args.iter().map(String::as_str).collect::<Vec<_>>())
}

fn planned(folder: &Path) -> Vec<Value> {
    let lines = succeed(folder, &["--plan"]);
    lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap()
}

#[test]
fn units_and_then_the_command_are_the_command_alone() {
    let (apart, whole) = (folder_with_space(), folder_with_space());
    let units = planned(apart.path());
    assert_eq!(units.len(), 4, "{units:?}");
    assert!(!apart.path().join("out").exists());
    for unit in &units {
        let file = text(&unit["file"]);
        // The whole line is as good as the name of a unit.
        let line = unit.to_string();
        let which = if unit == &units[0] { text(&unit["unit"]) } else { &line };
        let said = succeed(apart.path(), &["--only", which]);
        let clip = text(&unit["clip"]);
        assert_eq!(
            said,
            format!(
                "{file}: {} designs over {clip}\n",
                unit["combinations"].as_array().unwrap().len()
            )
        );
        assert!(apart.path().join(file).is_file());
    }
    assert!(!apart.path().join("out/points.csv").exists());
    assert_eq!(succeed(apart.path(), &[]), succeed(whole.path(), &[]));
    fs::remove_dir_all(apart.path().join("out/units")).unwrap();
    assert_eq!(files_below(apart.path()), files_below(whole.path()));
}

#[test]
fn mistakes_are_one_line() {
    let dir = folder_with_space();
    let wrong = |more: &[&str], parts: &[&str]| {
        let args = explore(more);
        expect_failure(dir.path(), 2, &args.iter().map(String::as_str).collect::<Vec<_>>(), parts);
    };
    let unit = planned(dir.path()).remove(0);
    wrong(&["--only", text(&unit["unit"]), "--rate", "25"], &["no unit", "the options"]);
    fs::write(dir.path().join("space.toml"), SPACE.replace("70", "71")).unwrap();
    wrong(&["--only", text(&unit["unit"])], &["no unit", "the space"]);
    assert!(!dir.path().join("out").exists());
}

#[test]
fn a_clip_that_changed_since_the_plan_is_refused() {
    let dir = folder_with_space();
    let made = ["simulate", "scene:street", "-o", "made", "--frames", "4", "--quiet"];
    run_successfully(dir.path(), &made);
    let run =
        ["explore", "space.toml", "made/rendered", "-o", "out", "--no-area", "--resize", "64x48"];
    let plan = run_successfully(dir.path(), &[&run[..], &["--plan"]].concat());
    let unit: Value = serde_json::from_str(plan.lines().next().unwrap()).unwrap();
    let only = [&run[..], &["--only", text(&unit["unit"])]].concat();
    run_successfully(dir.path(), &only);
    fs::copy(dir.path().join("made/rendered/000001.png"), dir.path().join("made/rendered/9.png"))
        .unwrap();
    expect_failure(dir.path(), 2, &only, &["no unit", "the clips", "plan again"]);
}

#[test]
fn a_unit_of_a_clip_that_breaks_off_is_not_done() {
    let dir = folder_with_space();
    let frame = [&b"FRAME\n"[..], &[7; 64 * 48]].concat();
    let mut clip = b"YUV4MPEG2 W64 H48 F30:1 Cmono\n".to_vec();
    (0..3).for_each(|_| clip.extend(&frame));
    clip.truncate(clip.len() - 100);
    fs::write(dir.path().join("cut.y4m"), clip).unwrap();
    let run = ["explore", "space.toml", "cut.y4m", "-o", "out", "--no-area"];
    let plan = run_successfully(dir.path(), &[&run[..], &["--plan"]].concat());
    let line = plan.lines().next().unwrap();
    let only = [&run[..], &["--only", line]].concat();
    expect_failure(dir.path(), 1, &only, &["`cut` is not complete"]);
    let there = files_below(&dir.path().join("out"));
    assert_eq!(there.len(), 1, "only the mark of the folder: {there:?}");
}

/// The process is killed as a job system or a lack of memory kills it, so that it cannot clean up.
#[cfg(unix)]
#[test]
fn workers_that_are_killed_lose_only_what_they_were_at() {
    let (dir, whole) = (folder_with_space(), folder_with_space());
    let units = planned(dir.path());
    let start = |unit: &Value| -> Child {
        let args = explore(&["--only", text(&unit["unit"]), "--quiet"]);
        foveate_with_signals()
            .args(args)
            .current_dir(dir.path())
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    succeed(dir.path(), &["--only", text(&units[0]["unit"])]);
    let before = files_below(&dir.path().join("out"));
    let measured = dir.path().join("out/measured");
    let count = || fs::read_dir(&measured).unwrap().count();
    let finished = count();
    for attempt in 0..20 {
        let mut child = start(&units[1]);
        // The process is killed at its first result, or a little before.
        while attempt % 4 > 0 && count() == finished && child.try_wait().unwrap().is_none() {}
        child.kill().unwrap();
        child.wait().unwrap();
        let now = files_below(&dir.path().join("out"));
        assert!(before.iter().all(|file| now.contains(file)), "attempt {attempt}");
        for (path, bytes) in now {
            let name = path.file_name().unwrap().to_string_lossy();
            let whole = serde_json::from_slice::<Value>(&bytes).is_ok();
            assert!(whole || name.starts_with(".foveate-"), "{name}, attempt {attempt}");
            if !before.contains(&(path.clone(), bytes)) && attempt < 19 {
                fs::remove_file(dir.path().join("out").join(path)).unwrap();
            }
        }
    }
    for unit in &units {
        succeed(dir.path(), &["--only", text(&unit["unit"])]);
    }
    succeed(dir.path(), &[]);
    succeed(whole.path(), &[]);
    let table = |dir: &tempfile::TempDir| fs::read(dir.path().join("out/points.csv")).unwrap();
    assert_eq!(table(&dir), table(&whole));
}

/// The sizes of the disk range from one without room for the folder to one with room for some
/// results.
#[cfg(target_os = "linux")]
#[test]
fn a_unit_for_which_there_is_no_room_is_not_done() {
    let dir = folder_with_space();
    let units = planned(dir.path());
    let args = format!(
        "explore '{}' scene:street scene:shake --frames 6 --no-area --only {}",
        dir.path().join("space.toml").display(),
        text(&units[0]["unit"])
    );
    let mut counts = Vec::new();
    for kib in [4, 8, 16, 32] {
        let Some((ran, copy)) = run_within(kib, dir.path(), &args) else { return };
        let said = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert_eq!(ran.status.code(), Some(2), "{kib} KiB: {said}");
        assert!(said.contains("No space left on device") || said.contains("free space"), "{said}");
        let there = files_below(&copy);
        for (path, bytes) in &there {
            assert!(serde_json::from_slice::<Value>(bytes).is_ok(), "{kib} KiB: {path:?}");
            assert!(!path.starts_with("out/units"), "{kib} KiB: {path:?}");
        }
        counts.push(there.iter().filter(|(path, _)| path.starts_with("out/measured")).count());
        fs::remove_dir_all(copy).unwrap();
    }
    assert!(
        counts.contains(&0) && counts.iter().any(|count| (1..16).contains(count)),
        "{counts:?}"
    );
}
