// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `simulate`, end to end.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, files_below, run_in, run_successfully};
use serde_json::Value;

#[test]
fn a_scene_becomes_arrays_pictures_and_a_summary() {
    let dir = tempfile::tempdir().unwrap();
    let args = ["simulate", "scene:street", "-o", "out", "--frames", "3", "--overlay", "--json"];
    let summary: Value = serde_json::from_str(&run_successfully(dir.path(), &args)).unwrap();
    assert_eq!((&summary["frames"], &summary["regions"]), (&3.into(), &784.into()));
    let names: Vec<_> =
        files_below(&dir.path().join("out")).into_iter().map(|(name, _)| name).collect();
    for name in ["srs.npy", "trs.npy", "t_count.npy", "score_edge.npy", "summary.json"] {
        assert!(names.iter().any(|path| path == Path::new(name)), "{name} of {names:?}");
    }
    for name in ["rendered/000002.png", "overlay/000002.png"] {
        assert!(names.iter().any(|path| path == Path::new(name)), "{name} of {names:?}");
    }
    let again = ["simulate", "scene:street", "-o", "out", "--frames", "3"];
    expect_failure(dir.path(), 2, &again, &["out", "not empty"]);
    run_successfully(dir.path(), &[&again[..], &["--force", "--no-rendered"]].concat());
    assert!(!dir.path().join("out/rendered").exists());
}

/// An interrupt ends a long run soon, with a message, and leaves the results so far.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_what_was_done() {
    let dir = tempfile::tempdir().unwrap();
    let child = crate::common::foveate_with_signals()
        .args(["simulate", "scene:street", "-o", "out", "--frames", "100000"])
        .current_dir(dir.path())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // The temporary folder has its second picture when two frames are done.
    let done = || {
        let hidden = fs::read_dir(dir.path()).unwrap().next()?.ok()?.path();
        hidden.join("work/rendered/000001.png").exists().then_some(())
    };
    while done().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("interrupted") && said.contains("`out`"), "{said}");
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    let summary = fs::read(dir.path().join("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    assert_eq!((&summary["complete"], &summary["problem"]), (&false.into(), &"interrupted".into()));
    assert!(summary["frames"].as_u64().unwrap() > 0);
}

/// This test uses real images, if the environment variable FOVEATE_DATA names their folder.
#[test]
fn real_images_run() {
    let Some(data) = foveate_tools::testing::data_folder() else {
        return;
    };
    let folder = data.join("mosquito/aedes");
    let dir = tempfile::tempdir().unwrap();
    let input = folder.to_str().unwrap();
    let args = ["simulate", input, "-o", "out", "--frames", "20", "--no-rendered", "--json"];
    let outcome = run_in(dir.path(), &args);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let summary: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!((&summary["frames"], &summary["width"]), (&20.into(), &224.into()));
    let share = summary["srs_share"].as_f64().unwrap();
    assert!(share > 0.01 && share < 0.99, "real images have edges here and there: {share}");
}

/// Thresholds depend on the depth, whether the file leaves them out or has every key.
#[test]
fn a_camera_of_five_bits_sees_as_much_as_one_of_eight() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("camera.toml"), run_successfully(dir.path(), &["presets", "paper"]))
        .unwrap();
    let active = |more: &[&str]| {
        let frame = ["--frames", "6", "--no-rendered", "--force", "--json"];
        let size = ["--set", "frame.width=128", "--set", "frame.height=96"];
        let args = [&["simulate", "scene:street", "-o", "out"], &frame[..], &size, more].concat();
        let summary: Value = serde_json::from_str(&run_successfully(dir.path(), &args)).unwrap();
        summary["active_share"].as_f64().unwrap()
    };
    let eight = active(&[]);
    assert!(eight > 0.1, "{eight}");
    let five = ["--set", "frame.pixel_bits=5"];
    for share in [active(&five), active(&[&["--config", "camera.toml"], &five[..]].concat())] {
        assert!((share / eight - 1.0).abs() < 0.1, "{share} of {eight}");
    }
}
