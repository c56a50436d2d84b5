// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of players: frames come in order and ahead of the work, buffers return, and no reader
//! remains.

use std::time::{Duration, Instant};

use foveate_camera::CameraConfig;
use foveate_engine::Engine;
use foveate_media::{FrameDepths, PlaybackError, SourceKind};

use crate::support::{CountedSource, SIDE};

/// Waits until a condition holds.
fn wait_for(what: &str, condition: impl Fn() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < Duration::from_secs(20), "{what}");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn engine(bits: u32) -> Engine {
    let mut config = CameraConfig::default();
    config.frame.pixel_bits = bits;
    Engine::new(&config.validate_for_frames(SIDE, SIDE).unwrap())
}

#[test]
fn frames_come_in_order_and_their_memory_returns() {
    let source = CountedSource { problem: Some("cut".to_owned()), ..CountedSource::new(50) };
    let counts = source.counts.clone();
    let mut player = source.player();
    assert_eq!((player.size(), player.frames()), ((SIDE, SIDE), Some(50)));
    for number in 0..50 {
        let frame = player.next().unwrap().unwrap();
        assert_eq!((frame.number, frame.time_us), (number, number));
        assert_eq!(frame.is_first(), number == 0);
        assert!(player.problem().is_none());
    }
    assert!(player.next().is_none() && player.next().is_none());
    assert_eq!((player.problem(), player.inputs().join(",")), (Some("cut"), "counted".to_owned()));
    assert!(counts.recycled.load(std::sync::atomic::Ordering::Relaxed) >= 44);
}

#[test]
fn a_bounded_number_of_frames_is_read_ahead() {
    let source = CountedSource::new(100);
    let counts = source.counts.clone();
    let mut player = source.player();
    assert_eq!(counts.read(), 0, "nobody has asked for a frame");
    let first = player.next().unwrap().unwrap();
    // One frame is out, three wait, and one waits for room.
    wait_for("reading ahead", || counts.read() == 5);
    std::thread::sleep(Duration::from_millis(20));
    assert_eq!(counts.read(), 5);
    // A frame outlives its player.
    drop(player);
    assert_eq!(first.name, "0");
}

#[test]
fn a_limit_ends_the_clip_and_the_reading() {
    let source = CountedSource { problem: Some("cut".to_owned()), ..CountedSource::new(100) };
    let counts = source.counts.clone();
    let mut player = source.player().limited_to(7);
    assert_eq!(player.by_ref().map(|frame| frame.unwrap().number).max(), Some(6));
    assert_eq!((counts.read(), player.problem()), (7, None));
    assert_eq!(CountedSource::new(9).player().limited_to(0).count(), 0);
}

#[test]
fn a_clip_without_frames_is_an_error() {
    let mut player = CountedSource::new(0).player();
    let error = player.next().unwrap().unwrap_err().to_string();
    assert_eq!(error, "counted holds no frame; at least one is needed");
    assert!(player.next().is_none());
}

#[test]
#[should_panic(expected = "the source has a fault")]
fn a_panic_of_the_reader_is_one_of_the_player() {
    let source = CountedSource { panic_at: Some(2), ..CountedSource::new(9) };
    source.player().for_each(|frame| drop(frame.unwrap()));
}

#[test]
fn cameras_are_reset_between_the_frames_of_a_set_in_every_depth() {
    for (kind, later_frames_change) in [(SourceKind::Clip, false), (SourceKind::Set, true)] {
        let player = CountedSource { kind, ..CountedSource::new(3) }.player();
        let mut engines = [8, 4, 12].map(engine);
        for frame in player {
            let frame = frame.unwrap();
            assert_eq!(frame.is_first(), frame.number == 0 || later_frames_change);
            let depths = FrameDepths::from_frame(&frame, [8, 4, 12]).unwrap();
            for engine in &mut engines {
                let outcome = depths.show_to(engine).unwrap();
                assert_eq!(outcome.trs.contains(&true), frame.is_first(), "{kind:?}");
            }
        }
    }
}

#[test]
fn a_frame_of_another_depth_is_refused() {
    let mut player = CountedSource::new(1).player();
    let frame = player.next().unwrap().unwrap();
    let error = frame.show_to(&mut engine(4)).unwrap_err();
    assert!(matches!(error, PlaybackError::Input(_)), "{error}");
}

/// Work that stops early ends the reader although its input waits, and an interrupt ends the wait
/// of the player.
#[cfg(unix)]
#[test]
fn no_reader_hangs_on_an_input_that_waits() {
    use std::io::Write as _;
    use std::sync::atomic::Ordering;

    use foveate_media::{ClipPlayer, InputOptions};

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stream.y4m");
    let made = std::process::Command::new("mkfifo").arg(&path).status().unwrap();
    assert!(made.success());
    for is_interrupted in [false, true] {
        // The writer opens the pipe as soon as the player reads it, and then sends nothing more.
        let writer = {
            let path = path.clone();
            std::thread::spawn(move || {
                let mut pipe = std::fs::File::options().write(true).open(path).unwrap();
                pipe.write_all(b"YUV4MPEG2 W16 H16 F25:1 Cmono\nFRAME\n").unwrap();
                pipe.write_all(&[7; 256]).unwrap();
                pipe
            })
        };
        let options = InputOptions::default();
        let mut player = ClipPlayer::open(&[&path], &CameraConfig::default(), &options).unwrap();
        let pipe = writer.join().unwrap();
        assert_eq!(player.next().unwrap().unwrap().number, 0);
        let start = Instant::now();
        if is_interrupted {
            options.interrupt.flag().store(true, Ordering::Relaxed);
            let error = player.next().unwrap().unwrap_err();
            assert!(matches!(error, PlaybackError::Interrupted), "{error}");
        }
        drop(player);
        assert!(start.elapsed() < Duration::from_secs(10), "{is_interrupted}");
        drop(pipe);
    }
}
