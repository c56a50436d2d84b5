// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs over several clips: each clip has the results of a run of its own, and the totals are those
//! of all clips.

use crate::common::{RunSetup, TableRow, is_counted, is_near, number, rows, text};
use foveate_inference::{Computation, TuningGoal};
use foveate_media::testing::RecordingHooks;
use foveate_network::ExecutionMode;

/// Returns the bytes of an array after its header.
fn values(folder: &std::path::Path) -> Vec<u8> {
    std::fs::read(folder.join("out/outputs/clean.npy")).unwrap()[128..].to_vec()
}

/// Removes the time from the rows of a run.
fn timeless(rows: Vec<TableRow>) -> Vec<TableRow> {
    let strip = |mut row: TableRow| {
        row.remove("seconds");
        row
    };
    rows.into_iter().map(strip).collect()
}

/// Frames, layers and outputs of a run over clips are those of separate runs, one after the other.
#[test]
fn a_run_over_clips_equals_runs_over_each_clip() {
    let dir = tempfile::tempdir().unwrap();
    for mode in [
        ExecutionMode::Exact,
        ExecutionMode::Compare,
        ExecutionMode::Truncate(0.05),
        ExecutionMode::Fixed,
    ] {
        let all = ["scene:street", "scene:shake", "scene:fade"];
        let run = |inputs: &[&str]| {
            let computed = Computation::Mode(mode);
            let run =
                RunSetup { inputs, computed, accelerator: Some("eyeriss"), ..RunSetup::default() };
            let summary = run.write(dir.path()).unwrap();
            let tables = ["frames.parquet", "layers_frames.parquet"];
            let tables = tables.map(|table| timeless(rows(dir.path(), table)));
            (summary, tables, values(dir.path()))
        };
        let (together, tables, found) = run(&all);
        let (mut expected, mut outputs, mut needed) = ([Vec::new(), Vec::new()], Vec::new(), 0.0);
        for (clip, told) in all.iter().zip(&together.clips) {
            let (alone, [frames, details], values) = run(&[clip]);
            expected[0].extend(frames);
            expected[1].extend(details);
            outputs.extend(values);
            needed += alone.macs.needed;
            assert_eq!(format!("scene:{}", told.name), *clip);
            assert_eq!((told.frames, told.counted_frames), (4, 3));
            assert!(is_near(told.macs.needed, alone.macs.needed), "{mode:?}: {clip}");
            assert!(is_near(told.changed_share, alone.changed_share), "{mode:?}: {clip}");
            assert_eq!(alone.clips.len(), 1);
        }
        assert_eq!(tables, expected, "{mode:?}");
        assert!(found == outputs, "{mode:?}");
        assert_eq!((together.frames, together.counted_frames), (12, 9));
        assert!(is_near(together.macs.needed, needed / 3.0), "{mode:?}");
    }
}

/// A clip with a single frame, which is not counted, takes a place among the frames of all clips.
/// So the counted frames of three clips with 4, 1 and 4 frames are 1 to 3 and 6 to 8.
#[test]
fn a_clip_with_a_single_frame_has_a_place_in_the_run() {
    let dir = tempfile::tempdir().unwrap();
    let single = dir.path().join("single");
    std::fs::create_dir(&single).unwrap();
    let pixels = vec![90; 64 * 48];
    std::fs::write(single.join("0.pgm"), [b"P5\n64 48\n255\n".to_vec(), pixels].concat()).unwrap();
    let inputs = ["scene:street", single.to_str().unwrap(), "scene:fade"];
    let summary = RunSetup { inputs: &inputs, ..RunSetup::default() }.write(dir.path()).unwrap();
    assert_eq!(summary.clips.iter().map(|clip| clip.frames).collect::<Vec<_>>(), [4, 1, 4]);
    let page = std::fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    let has_row = |index: &u32| page.contains(&format!("id=\"pf{index}\""));
    assert_eq!((0..12).filter(has_row).collect::<Vec<_>>(), [1, 2, 3, 6, 7, 8]);
}

/// Limits are chosen on the first half of the clips, rounded up, and only the other clips are
/// reported.
#[test]
fn limits_of_some_clips_are_reported_on_the_others() {
    let dir = tempfile::tempdir().unwrap();
    let computed = Computation::Tuned(TuningGoal::Variation(0.3));
    let all = ["scene:street", "scene:shake", "scene:fade"];
    let run = |inputs, frames| RunSetup { inputs, frames, computed, ..RunSetup::default() };
    let summary = run(&all, 3).write(dir.path()).unwrap();
    let tuning = summary.tuning.as_ref().unwrap();
    assert_eq!(
        (&tuning.clips[..], tuning.frames),
        (&["street", "shake"].map(str::to_owned)[..], 4)
    );
    let frames = rows(dir.path(), "frames.parquet");
    assert!(frames.iter().all(|row| text(row, "clip") == "fade"));
    assert_eq!(frames.iter().map(|row| number(row, "frame")).collect::<Vec<_>>(), [0.0, 1.0, 2.0]);
    assert_eq!((summary.frames, summary.counted_frames, summary.clips.len()), (3, 2, 1));
    assert_eq!(summary.inputs, all);
    // The limits do not depend on the clips after those that they are chosen on.
    let limits = |inputs| {
        let summary = run(inputs, 3).write(dir.path()).unwrap();
        summary.layers.iter().map(|layer| layer.limit).collect::<Vec<_>>()
    };
    let chosen: Vec<_> = summary.layers.iter().map(|layer| layer.limit).collect();
    assert!(chosen.iter().flatten().any(|&limit| limit > 0.0));
    assert_eq!(limits(&["scene:street", "scene:shake", "scene:zero", "scene:flicker"]), chosen);
    // Differences between clips are not variation: frozen outputs are as far away as in the clip
    // that varies.
    let far = |inputs| run(inputs, 3).write(dir.path()).unwrap().tuning.unwrap().frozen.outputs;
    let (alone, beside) =
        (far(&["scene:street", "scene:fade"]), far(&["scene:street", "scene:zero", "scene:fade"]));
    assert!(is_near(alone.rms_of_variation, beside.rms_of_variation), "{alone:?} {beside:?}");
    let error = run(&all, 1).write(dir.path()).unwrap_err().to_string();
    assert!(error.starts_with("no frame of the clips to tune on counts"), "{error}");
}

/// An interrupted run keeps the frames that were done, and says which clip stopped and how many
/// clips were never begun.
#[test]
fn an_interrupted_run_keeps_the_clips_before() {
    let dir = tempfile::tempdir().unwrap();
    let run =
        RunSetup { inputs: &["scene:street", "scene:shake", "scene:fade"], ..RunSetup::default() };
    for (after, clips, problem) in [
        (4, 1, "clips that were not begun: 2"),
        (6, 2, "`shake`: it was interrupted; clips that were not begun: 1"),
        (10, 3, "`fade`: it was interrupted"),
    ] {
        let hooks = RecordingHooks::cancelling_after(usize::try_from(after).unwrap());
        let summary = run.write_with_hooks(dir.path(), &hooks).unwrap();
        // The total is that of all clips.
        let reports = hooks.reports();
        assert!((1..).zip(reports.iter()).all(|(n, one)| (one.done, one.total) == (n, Some(12))));
        assert_eq!(summary.problem.as_deref(), Some(problem), "{after}");
        assert_eq!((summary.frames, summary.clips.len()), (after, clips), "{after}");
        let frames = rows(dir.path(), "frames.parquet");
        assert_eq!(frames.len() as u64, after);
        assert_eq!(frames.iter().filter(|row| !is_counted(row)).count(), clips);
        assert!(
            rows(dir.path(), "layers_frames.parquet").len() as u64
                == after * summary.layers.len() as u64
        );
    }
    let hooks = RecordingHooks::cancelling_after(0);
    let nothing = run.write_with_hooks(dir.path(), &hooks).unwrap_err();
    assert_eq!(nothing.to_string(), "interrupted; nothing was written");
}
