// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of monitors: every frame is reported once it is done, and a run stops where it is told to.

use foveate_media::{PlaybackError, RunMonitor, RunProgress, testing::RecordingHooks};

use crate::support::CountedSource;

/// Plays a clip to its end, and returns the numbers of its frames, and whether it was interrupted.
fn play(monitor: &RunMonitor<'_>, source: CountedSource) -> (u64, bool) {
    let (mut player, mut frames) = (source.player(), 0);
    for frame in monitor.watch(&mut player) {
        match frame {
            Ok(frame) => assert_eq!(frame.number, frames),
            Err(PlaybackError::Interrupted) => return (frames, true),
            Err(error) => panic!("{error}"),
        }
        frames += 1;
    }
    (frames, false)
}

#[test]
fn every_frame_is_reported_when_it_is_done() {
    let hooks = RecordingHooks::new();
    let monitor = RunMonitor::of_frames(&hooks, Some(5));
    let mut player = CountedSource::new(3).player();
    for (number, frame) in (0..).zip(monitor.watch(&mut player)) {
        assert!(frame.is_ok() && hooks.reports().len() == number);
    }
    assert_eq!(play(&monitor, CountedSource::new(2)), (2, false));
    let expected: Vec<_> = (1..=5).map(|done| RunProgress::frames(done, Some(5), "")).collect();
    assert_eq!((&*hooks.reports(), monitor.frames_done()), (&expected, 5));
}

#[test]
fn clips_and_stages_are_reported() {
    let hooks = RecordingHooks::new();
    let monitor = RunMonitor::of_clips(&hooks, 2);
    play(&monitor, CountedSource::new(1));
    monitor.add_clip();
    let stage = |frames| RunProgress::steps("designs", frames, 8);
    play(&RunMonitor::of_stage(&hooks, &stage), CountedSource::new(1));
    let expected = [
        RunProgress::frames(1, None, "0/2 clips"),
        RunProgress::frames(1, None, "1/2 clips"),
        RunProgress::steps("designs", 1, 8),
    ];
    assert_eq!(*hooks.reports(), expected);
}

#[test]
fn a_run_stops_before_the_next_frame() {
    for most in 0..3 {
        let hooks = RecordingHooks::cancelling_after(most);
        let monitor = RunMonitor::of_frames(&hooks, None);
        assert_eq!(play(&monitor, CountedSource::new(9)), (most as u64, true));
        assert!(monitor.check().is_err());
    }
    // A request after the last frame comes too late, unless it has cut the clip short.
    for problem in [None, Some("ffmpeg was stopped".to_owned())] {
        let hooks = RecordingHooks::cancelling_after(2);
        let monitor = RunMonitor::of_frames(&hooks, None);
        let is_cut = problem.is_some();
        let source = CountedSource { problem, ..CountedSource::new(2) };
        assert_eq!(play(&monitor, source), (2, is_cut));
    }
}
