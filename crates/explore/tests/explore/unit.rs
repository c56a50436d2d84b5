// SPDX-License-Identifier: MIT OR Apache-2.0
//! Explorations in units: together they equal the exploration, byte for byte, in any order and more
//! than once.

use std::fs;
use std::path::{Path, PathBuf};

use foveate_explore::{
    DesignSpace, ExploreError, ExploreRequest, WorkUnit, measure_unit, plan_units,
};
use foveate_media::{InputOptions, PlaybackError, testing::RecordingHooks};

use crate::explore::{SPACE, run};

const CLIPS: [&str; 2] = ["scene:street", "scene:shake"];

/// Returns a space with more designs than see a clip together, of which some have equal cameras.
fn large_space() -> String {
    let counts: Vec<String> = (1..=20).map(|count| count.to_string()).collect();
    format!(
        "[design]\nframe.width = 48\nframe.height = 32\n[vary]\ntemporal.min_count = [{}]\n\
         hardware.organization = ['pipelined', 'serial']\n",
        counts.join(", ")
    )
}

fn with_request<T>(space: &str, inputs: &[&str], then: impl FnOnce(&ExploreRequest<'_>) -> T) -> T {
    let space = DesignSpace::from_toml(space).unwrap();
    let inputs: Vec<PathBuf> = inputs.iter().map(PathBuf::from).collect();
    let input = InputOptions { frames: Some(12), ..InputOptions::default() };
    then(&ExploreRequest {
        space: &space,
        inputs: &inputs,
        input: &input,
        disturbance: None,
        synthesis: None,
    })
}

pub(crate) fn units(space: &str, inputs: &[&str], output: &Path) -> Vec<WorkUnit> {
    with_request(space, inputs, |request| plan_units(request, output, &RecordingHooks::new()))
        .unwrap()
}

pub(crate) fn measure_only(
    space: &str,
    inputs: &[&str],
    unit: &str,
    output: &Path,
    watch: &RecordingHooks,
) -> Result<WorkUnit, ExploreError> {
    with_request(space, inputs, |request| measure_unit(request, unit, output, watch))
}

/// Returns every file of a folder by its name, sorted.
pub(crate) fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let file = |entry: fs::DirEntry| {
        (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())
    };
    let mut found: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(Result::unwrap)
        .filter(|e| e.path().is_file())
        .map(file)
        .collect();
    found.sort();
    found
}

#[test]
fn a_plan_has_every_clip_and_design_once_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let found = units(&large_space(), &CLIPS, &output);
    assert!(!output.exists());
    let seen: Vec<_> =
        found.iter().map(|unit| (unit.clip.as_str(), unit.combinations.len())).collect();
    // There are 20 different cameras; the organization does not change what a camera sees.
    assert_eq!(seen, [("street", 16), ("street", 4), ("shake", 16), ("shake", 4)]);
    for unit in &found {
        assert_eq!(unit.inputs, [format!("scene:{}", unit.clip)]);
        assert!(unit.file.ends_with(&format!("units/{}.json", unit.name)), "{unit:?}");
    }
    assert_eq!(units(&large_space(), &CLIPS, &output), found);
    // A unit does not depend on the other clips.
    assert_eq!(units(&large_space(), &CLIPS[1..], &output), found[2..]);
}

#[test]
fn units_in_any_order_are_the_whole_run_byte_for_byte() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, apart) = (folder.path().join("whole"), folder.path().join("apart"));
    let never_ends = || RecordingHooks::new();
    run(&large_space(), &CLIPS, &whole, &never_ends()).unwrap();
    for unit in units(&large_space(), &CLIPS, &apart).iter().rev() {
        let inputs: Vec<&str> = unit.inputs.iter().map(String::as_str).collect();
        // Units are named by their name or by their line.
        let line = serde_json::to_string(unit).unwrap();
        let which = if unit.clip == "street" { &unit.name } else { &line };
        let done = measure_only(&large_space(), &inputs, which, &apart, &never_ends()).unwrap();
        assert_eq!(&done, unit);
        assert!(Path::new(&done.file).is_file());
    }
    let collecting = never_ends();
    run(&large_space(), &CLIPS, &apart, &collecting).unwrap();
    assert_eq!(collecting.reports().len(), 0, "nothing is measured again");
    for below in ["", "measured", "designs"] {
        let (whole, apart) = (files(&whole.join(below)), files(&apart.join(below)));
        assert!(whole.len() > 5 && whole == apart, "{below}");
    }
}

#[test]
fn a_unit_is_done_by_many_at_once_and_again() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let unit = units(SPACE, &CLIPS, &output).remove(0);
    std::thread::scope(|scope| {
        let work =
            || measure_only(SPACE, &CLIPS, &unit.name, &output, &RecordingHooks::new()).unwrap();
        let all: Vec<_> = (0..8).map(|_| scope.spawn(work)).collect();
        all.into_iter().for_each(|one| drop(one.join().unwrap()));
    });
    let measured = files(&output.join("measured"));
    assert_eq!((measured.len(), files(&output.join("units")).len()), (unit.combinations.len(), 1));
    let again = RecordingHooks::cancelling_after(1);
    measure_only(SPACE, &CLIPS, &unit.name, &output, &again).unwrap();
    assert_eq!(again.reports().len(), 0);
    assert_eq!(files(&output.join("measured")), measured);
}

#[test]
fn a_stopped_unit_is_not_done() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let unit = units(SPACE, &CLIPS, &output).remove(0);
    let stopped =
        measure_only(SPACE, &CLIPS, &unit.name, &output, &RecordingHooks::cancelling_after(4));
    assert!(
        matches!(stopped, Err(ExploreError::Playback(PlaybackError::Interrupted))),
        "{stopped:?}"
    );
    assert!(files(&output.join("measured")).is_empty() && !output.join("units").exists());
}

#[test]
fn a_unit_of_another_plan_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let unit = units(SPACE, &CLIPS, &output).remove(0);
    let other = SPACE.replace("[8, 6, 3]", "[8, 6, 2]");
    let line = serde_json::to_string(&unit).unwrap();
    let mut beyond = unit.clone();
    beyond.combinations.push(100);
    beyond.combinations.remove(0);
    let beyond = serde_json::to_string(&beyond).unwrap();
    for (space, which) in
        [(other.as_str(), &unit.name), (&other, &line), (SPACE, &beyond), (SPACE, &"{}".to_owned())]
    {
        let refused =
            measure_only(space, &CLIPS, which, &output, &RecordingHooks::cancelling_after(1))
                .unwrap_err();
        assert!(matches!(refused, ExploreError::NoUnit { .. }), "{refused}");
        assert!(refused.to_string().contains("plan again"), "{refused}");
    }
    assert!(!output.exists());
}

#[test]
fn a_folder_of_something_else_is_refused_also_by_a_plan() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("mine");
    let unit = units(SPACE, &CLIPS, &output).remove(0);
    fs::create_dir(&output).unwrap();
    // The folder may hold a temporary file of a killed worker, and the folder that waits for the
    // files of the units.
    fs::write(output.join(".foveate-killed"), "{").unwrap();
    fs::create_dir(output.join("units")).unwrap();
    assert_eq!(units(SPACE, &CLIPS, &output)[0], unit);
    fs::write(output.join("notes.txt"), "mine").unwrap();
    let planned = with_request(SPACE, &CLIPS, |request| {
        plan_units(request, &output, &RecordingHooks::cancelling_after(1))
    });
    let done =
        measure_only(SPACE, &CLIPS, &unit.name, &output, &RecordingHooks::cancelling_after(1));
    for error in [planned.unwrap_err(), done.unwrap_err()] {
        assert!(matches!(error, ExploreError::OtherFolder { .. }), "{error}");
    }
}
