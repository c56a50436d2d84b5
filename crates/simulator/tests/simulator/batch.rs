// SPDX-License-Identifier: MIT OR Apache-2.0
//! Batches: the division of inputs into clips, the place of each output, and a failing clip among
//! others.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{grey, names};
use foveate_design::DesignConfig;
use foveate_media::{
    BatchClip, ClipPlan, FootageError, ImageRelation, InputOptions, RunProgress, plan,
    testing::RecordingHooks,
};
use foveate_simulator::{RunOptions, SimulatorError, run_batch};

/// Writes a stream of `frames` frames of 16x16 pixels.
fn y4m(path: &Path, frames: u8) -> PathBuf {
    let mut bytes = b"YUV4MPEG2 W16 H16 F25:1 Cmono\n".to_vec();
    for frame in 0..frames {
        bytes.extend(b"FRAME\n");
        bytes.extend((0..=255u8).map(|pixel| pixel.wrapping_mul(frame + 1)));
    }
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, bytes).unwrap();
    path.to_owned()
}

fn planned<P: AsRef<Path>>(inputs: &[P]) -> Vec<BatchClip> {
    match plan(inputs, &InputOptions::default()).unwrap() {
        ClipPlan::One => Vec::new(),
        ClipPlan::Batch(clips) => clips,
    }
}

/// Makes a tree with videos, folders of frames, and classes.
fn tree(root: &Path) {
    y4m(&root.join("top.y4m"), 2);
    y4m(&root.join("cars/a.y4m"), 2);
    y4m(&root.join("cars/a.avi"), 3);
    y4m(&root.join("people/day/b.y4m"), 1);
    fs::create_dir_all(root.join("people/walk")).unwrap();
    fs::create_dir_all(root.join("alone")).unwrap();
    for number in 0..2 {
        grey(&root.join(format!("people/walk/{number}.png")), 16, 16, |x, _| {
            u8::try_from(x).unwrap()
        });
        grey(&root.join(format!("alone/{number}.png")), 16, 16, |_, _| 9);
    }
    fs::write(root.join("notes.txt"), "no clip").unwrap();
}

#[test]
fn a_tree_gives_its_clips_at_their_places_with_labels() {
    let dir = tempfile::tempdir().unwrap();
    tree(dir.path());
    let clips = planned(&[dir.path()]);
    let seen: Vec<_> = clips
        .iter()
        .map(|clip| (clip.output_folder.to_str().unwrap(), clip.label.as_deref()))
        .collect();
    let expected = [
        ("alone", None),
        ("cars/a", Some("cars")),
        ("cars/a-2", Some("cars")),
        ("people/day/b", Some("people")),
        ("people/walk", Some("people")),
        ("top", None),
    ];
    assert_eq!(seen, expected);
}

#[test]
fn what_is_one_clip_is_no_batch() {
    let dir = tempfile::tempdir().unwrap();
    tree(dir.path());
    let at = |name: &str| dir.path().join(name);
    assert!(planned(&[at("top.y4m")]).is_empty());
    assert!(planned(&[at("people/walk")]).is_empty());
    assert!(planned(&[at("alone/0.png"), at("people/walk/1.png"), at("alone/*.png")]).is_empty());
    assert!(planned(&["scene:street"]).is_empty() && planned(&["-"]).is_empty());
    assert!(planned(&[at("missing.mp4")]).is_empty(), "opening says that it is missing");
    let set = InputOptions { images: ImageRelation::Set, ..InputOptions::default() };
    assert_eq!(plan(&[at("people")], &set).unwrap(), ClipPlan::One);
    assert_eq!(planned(&[at("alone"), at("people/walk")]).len(), 2);
    assert_eq!(planned(&[at("top.y4m"), at("cars")]).len(), 3);
    for mixed in [["top.y4m", "alone/0.png"], ["top.y4m", "gone.mp4"]] {
        let error = plan(&mixed.map(at), &InputOptions::default()).unwrap_err();
        assert!(matches!(error, FootageError::NotAlone { .. }), "{error}");
    }
    fs::create_dir(at("empty")).unwrap();
    let error = plan(&[at("empty")], &InputOptions::default()).unwrap_err();
    assert!(matches!(error, FootageError::EmptyFolder { .. }), "{error}");
}

fn run(
    inputs: &[PathBuf],
    output: &Path,
    hooks: &RecordingHooks,
) -> Result<serde_json::Value, SimulatorError> {
    let summary = run_batch(
        &planned(inputs),
        &DesignConfig::default(),
        &InputOptions::default(),
        output,
        &RunOptions::default(),
        hooks,
    )?;
    let written: serde_json::Value =
        serde_json::from_slice(&fs::read(output.join("summary.json")).unwrap()).unwrap();
    assert_eq!(written["frames"], summary.frames);
    Ok(written)
}

#[test]
fn every_clip_gets_its_folder_and_a_failing_one_is_listed() {
    let dir = tempfile::tempdir().unwrap();
    let (input, output) = (dir.path().join("in"), dir.path().join("out"));
    tree(&input);
    let hooks = RecordingHooks::new();
    let summary = run(std::slice::from_ref(&input), &output, &hooks).unwrap();
    assert_eq!((&summary["complete"], &summary["frames"]), (&true.into(), &12.into()));
    assert_eq!(names(&output), [".foveate", "alone", "cars", "people", "summary.json", "top"]);
    assert!(output.join("people/day/b/summary.json").is_file());
    assert_eq!(summary["clips"][1]["label"], "cars");
    let last = RunProgress::frames(12, None, "6/6 clips");
    assert!(hooks.reports().contains(&last), "{:?}", hooks.reports());

    let cut = fs::read(input.join("top.y4m")).unwrap();
    fs::write(input.join("top.y4m"), &cut[..cut.len() - 9]).unwrap();
    fs::write(input.join("alone/1.png"), "no image").unwrap();
    let other = dir.path().join("other");
    let summary = run(&[input], &other, &RecordingHooks::new()).unwrap();
    assert_eq!(summary["problem"], "2 of 6 clips are not complete");
    assert_eq!(names(&other), [".foveate", "cars", "people", "summary.json", "top"]);
    let clips = summary["clips"].as_array().unwrap();
    assert!(
        clips[0]["problem"].as_str().unwrap().contains("1.png") && clips[0]["output"].is_null()
    );
    assert!(clips[5]["problem"].as_str().unwrap().contains("ends inside a frame"));
    assert_eq!((&clips[5]["frames"], &clips[5]["output"]), (&1.into(), &"top".into()));
    assert_eq!(names(dir.path()), ["in", "other", "out"]);
}

#[test]
fn an_interrupted_batch_keeps_what_was_done() {
    let dir = tempfile::tempdir().unwrap();
    let clips: Vec<PathBuf> =
        (0..9).map(|clip| y4m(&dir.path().join(format!("{clip}.y4m")), 50)).collect();
    let output = dir.path().join("out");
    let summary = run(&clips, &output, &RecordingHooks::cancelling_after(60)).unwrap();
    assert_eq!((&summary["complete"], &summary["problem"]), (&false.into(), &"interrupted".into()));
    let frames = summary["frames"].as_u64().unwrap();
    assert!((50..200).contains(&frames), "{frames}");
}

#[test]
fn when_every_clip_fails_nothing_is_left() {
    let dir = tempfile::tempdir().unwrap();
    let clips: Vec<PathBuf> =
        (0..3).map(|clip| y4m(&dir.path().join(format!("{clip}.y4m")), 0)).collect();
    let output = dir.path().join("out");
    let error = run(&clips, &output, &RecordingHooks::new()).unwrap_err();
    assert!(matches!(error, SimulatorError::NoClip { clips: 3, .. }), "{error}");
    assert!(!output.exists());
}
