// SPDX-License-Identifier: MIT OR Apache-2.0
//! The output folder is complete or does not exist, and files of other origin are not touched.

use std::fs;
use std::path::Path;

use crate::support::{NpyArray, grey, names, run};
use foveate_design::DesignConfig;
use foveate_media::{
    FootageError, FrameSource, InputError, InputOptions, PlaybackError, RunHooks, RunProgress,
    SilentHooks, SourceFrame, open, testing::RecordingHooks,
};
use foveate_pixels::Frame;
use foveate_simulator::{RunOptions, Simulation, SimulatorError};
use foveate_tools::StagingError;

const SMALL: [&str; 2] = ["frame.width=16", "frame.height=16"];

fn plain() -> RunOptions {
    RunOptions::default()
}

fn overwrite() -> RunOptions {
    RunOptions { overwrite: true, ..plain() }
}

fn zero(output: &Path, options: &RunOptions) -> Result<(), SimulatorError> {
    run(&["scene:zero"], &SMALL, output, options).map(drop)
}

#[test]
fn a_run_leaves_its_folder_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    zero(&folder.path().join("new/out"), &plain()).unwrap();
    assert_eq!(names(folder.path()), ["new"]);
    assert_eq!(names(&folder.path().join("new")), ["out"]);
    let expected = [
        ".foveate",
        "active.npy",
        "frames.csv",
        "rendered",
        "score_edge.npy",
        "srs.npy",
        "summary.json",
        "t_count.npy",
        "trs.npy",
    ];
    assert_eq!(names(&folder.path().join("new/out")), expected);
}

#[test]
fn a_failing_run_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let frames = folder.path().join("frames");
    fs::create_dir(&frames).unwrap();
    for index in 0..4 {
        grey(&frames.join(format!("{index}.png")), 16, 16, |x, y| u8::try_from(x * y).unwrap());
    }
    let broken = frames.join("3.png");
    let whole = fs::read(&broken).unwrap();
    fs::write(&broken, &whole[..whole.len() / 2]).unwrap();
    let error = run(&[&frames], &[], &folder.path().join("out"), &plain()).unwrap_err();
    assert!(matches!(input_error(&error), InputError::Footage(FootageError::Truncated { .. })));
    assert_eq!(names(folder.path()), ["frames"]);

    grey(&broken, 17, 16, |_, _| 0);
    let error = run(&[&frames], &[], &folder.path().join("out"), &plain()).unwrap_err();
    assert!(matches!(input_error(&error), InputError::Footage(FootageError::MixedSizes { .. })));
    assert_eq!(names(folder.path()), ["frames"]);
}

/// Returns the fault of the input that stopped a simulation.
fn input_error(error: &SimulatorError) -> &InputError {
    let SimulatorError::Playback(error) = error else { panic!("{error}") };
    error.as_input().unwrap()
}

fn run_with(output: &Path, hooks: &dyn RunHooks) -> Result<(), SimulatorError> {
    let config = DesignConfig::from_toml_with("", &SMALL).unwrap();
    let source = open(&["scene:max"], &config.camera, &InputOptions::default())?;
    Simulation::new(&config, source)?.run(output, &plain(), hooks).map(drop)
}

#[test]
fn a_cancelled_run_leaves_what_was_done_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let hooks = RecordingHooks::cancelling_after(2);
    run_with(&output, &hooks).unwrap();
    assert_eq!(names(folder.path()), ["out"]);
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(output.join("summary.json")).unwrap()).unwrap();
    assert_eq!((&summary["frames"], &summary["complete"]), (&2.into(), &false.into()));
    assert_eq!(summary["problem"], "interrupted");
    let array = NpyArray::read(&output.join("trs.npy"));
    assert_eq!((array.shape, array.data.len()), (vec![2, 2, 2], 8));
    assert_eq!(fs::read_to_string(output.join("frames.csv")).unwrap().lines().count(), 3);
    assert_eq!(names(&output.join("rendered")).len(), 2);
}

#[test]
fn a_run_that_is_cancelled_at_once_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let hooks = RecordingHooks::cancelling_after(0);
    let error = run_with(&folder.path().join("out"), &hooks).unwrap_err();
    assert!(matches!(error, SimulatorError::Playback(PlaybackError::Interrupted)), "{error}");
    assert!(names(folder.path()).is_empty());
}

#[test]
fn progress_counts_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    let hooks = RecordingHooks::new();
    run_with(&folder.path().join("out"), &hooks).unwrap();
    let expected: Vec<_> = (1..=4).map(|done| RunProgress::frames(done, Some(4), "")).collect();
    assert_eq!(*hooks.reports(), expected);
    run_with(&folder.path().join("silent"), &SilentHooks).unwrap();
}

#[test]
fn a_folder_that_holds_something_is_refused_unless_overwriting_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    fs::create_dir(&output).unwrap();
    zero(&output, &plain()).unwrap();
    let error = zero(&output, &plain()).unwrap_err();
    assert!(matches!(error, SimulatorError::Output(StagingError::NotEmpty { .. })), "{error}");
    assert!(error.to_string().contains("out` is not empty"));
    // A file that is not in the list of written files belongs to the user.
    fs::write(output.join("mine.npy"), "").unwrap();
    let error = zero(&output, &overwrite()).unwrap_err();
    assert!(error.to_string().contains("mine.npy"), "{error}");
    fs::remove_file(output.join("mine.npy")).unwrap();
    zero(&output, &overwrite()).unwrap();
    assert!(output.join("summary.json").exists());
    assert_eq!(names(folder.path()), ["out"]);
}

#[test]
fn overwriting_spares_what_no_simulation_wrote() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("home");
    fs::create_dir(&output).unwrap();
    fs::write(output.join("thesis.tex"), "years of work").unwrap();
    let error = zero(&output, &overwrite()).unwrap_err();
    assert!(matches!(error, SimulatorError::Output(StagingError::OtherContent { .. })), "{error}");
    assert_eq!(fs::read_to_string(output.join("thesis.tex")).unwrap(), "years of work");
    assert_eq!(names(folder.path()), ["home"]);
}

#[test]
fn a_failing_overwrite_keeps_the_earlier_run() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    zero(&output, &plain()).unwrap();
    let before = fs::read(output.join("summary.json")).unwrap();
    let broken = folder.path().join("broken.png");
    let fine = grey(&folder.path().join("fine.png"), 8, 8, |_, _| 0);
    fs::write(&broken, "no image").unwrap();
    run(&[&fine, &broken], &[], &output, &overwrite()).unwrap_err();
    assert_eq!(fs::read(output.join("summary.json")).unwrap(), before);
    assert_eq!(names(folder.path()), ["broken.png", "fine.png", "out"]);
}

#[test]
fn places_that_cannot_be_written_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    for output in [file.clone(), file.join("out")] {
        let message = zero(&output, &plain()).unwrap_err().to_string();
        let named = format!("cannot write `{}`", output.display());
        assert!(message.starts_with(&named) && message.contains("choose another"), "{message}");
    }
    for output in ["", "/"] {
        let error = zero(Path::new(output), &overwrite()).unwrap_err();
        assert!(
            matches!(error, SimulatorError::Output(StagingError::InvalidPath { .. })),
            "{error}"
        );
    }
}

/// A source that is not one of the footage crate.
struct ForeignSource {
    inputs: [String; 1],
    frames: Vec<Frame>,
}

impl FrameSource for ForeignSource {
    fn size(&self) -> (u32, u32) {
        (16, 16)
    }

    fn inputs(&self) -> &[String] {
        &self.inputs
    }

    fn frames(&self) -> Option<u64> {
        None
    }

    fn next_frame(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        let name = "frame".to_owned();
        Ok(self.frames.pop().map(|frame| SourceFrame {
            name,
            time_us: 7,
            label: None,
            frame: (&frame).into(),
        }))
    }
}

#[test]
fn any_source_will_do_but_it_must_keep_its_word() {
    let folder = tempfile::tempdir().unwrap();
    let start = |frames| {
        let source = ForeignSource { inputs: ["camera 3".to_owned()], frames };
        let source: Box<dyn FrameSource> = Box::new(source);
        let simulation = Simulation::new(&DesignConfig::default(), source).unwrap();
        simulation.run(&folder.path().join("out"), &plain(), &SilentHooks)
    };
    let message = start(Vec::new()).unwrap_err().to_string();
    assert_eq!(message, "camera 3 holds no frame; at least one is needed");
    let good = Frame::filled(16, 16, 8, 1).unwrap();
    let bad = Frame::filled(16, 15, 8, 1).unwrap();
    let error = start(vec![bad, good.clone()]).unwrap_err();
    assert!(matches!(input_error(&error), InputError::RefusedFrame(_)));
    assert!(names(folder.path()).is_empty());
    assert_eq!(start(vec![good.clone(), good]).unwrap().frames, 2);
}
