// SPDX-License-Identifier: MIT OR Apache-2.0
//! Inputs that make a reader wait: FIFOs without a writer, and writers that stall. A request to
//! stop ends every wait.
#![cfg(unix)]

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::Ordering;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use crate::clips::{all, opened};
use foveate_media::{FootageError, InputOptions, TimestampUnit, TimestampsFile, plan, subjects};

fn fifo(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
    path
}

/// Returns the header of a stream and some grey frames.
fn stream(frames: usize) -> Vec<u8> {
    let mut bytes = b"YUV4MPEG2 W64 H48 F25:1 Cmono\n".to_vec();
    for frame in 0..frames {
        bytes.extend(b"FRAME\n");
        bytes.resize(bytes.len() + 64 * 48, u8::try_from(frame).unwrap());
    }
    bytes
}

#[test]
fn a_pipe_gives_its_frames_once() {
    let dir = tempfile::tempdir().unwrap();
    for name in ["a.y4m", "a", "a.mp4"] {
        let path = fifo(dir.path(), name);
        let writer = {
            let path = path.clone();
            std::thread::spawn(move || fs::write(path, stream(5)).unwrap())
        };
        let (seen, problem) = all(&path);
        assert_eq!((seen.len(), problem), (5, None), "{name}");
        assert!(foveate_media::is_read_once(&path));
        writer.join().unwrap();
    }
    // The image is not read from the pipe a second time, and the test does not wait for more data.
    let path = fifo(dir.path(), "b");
    let image = path.clone();
    let writer = std::thread::spawn(move || fs::write(image, b"\x89PNG\r\n\x1a\n more").unwrap());
    let error = opened(&path, 8, &InputOptions::default()).err().unwrap().to_string();
    assert!(error.contains("not a valid YUV4MPEG2 stream"), "{error}");
    writer.join().unwrap();
}

/// A read of any of these pipes would never end.
#[test]
fn a_pipe_among_files_is_not_waited_for() {
    let dir = tempfile::tempdir().unwrap();
    let pipe = fifo(dir.path(), "a.png");
    let options = InputOptions::default();
    let error = foveate_media::read(&pipe, 8).unwrap_err().to_string();
    assert!(error.contains("not a file"), "{error}");
    let inputs = [pipe.clone(), dir.path().join("b.png")];
    let error = plan(&inputs, &options).unwrap_err();
    assert!(matches!(error, FootageError::NotAlone { .. }), "{error}");
    assert!(foveate_media::input_warnings(&[&pipe], &options).is_empty());
    assert_eq!(subjects(&[pipe], &options).unwrap().len(), 1);
}

#[test]
fn a_request_to_stop_ends_every_wait() {
    let dir = tempfile::tempdir().unwrap();
    // In the first case no writer opens the pipe. In the others a writer stalls in the header,
    // between frames, or within a frame.
    for (case, written) in
        [None, Some(0), Some(12), Some(31 + 3078), Some(31 + 4000)].into_iter().enumerate()
    {
        let path = fifo(dir.path(), &format!("{case}.y4m"));
        let options = InputOptions::default();
        let interrupt = options.interrupt.clone();
        let (tell, told) = mpsc::channel();
        let reading = {
            let path = path.clone();
            std::thread::spawn(move || {
                let mut count = 0;
                let read = opened(&path, 8, &options).and_then(|mut source| {
                    while source.next_frame()?.is_some() {
                        count += 1;
                    }
                    Ok(())
                });
                tell.send(count).unwrap();
                read.unwrap_err()
            })
        };
        let writer = written.map(|length| {
            let mut writer = File::create(&path).unwrap();
            writer.write_all(&stream(3)[..length]).unwrap();
            writer
        });
        std::thread::sleep(Duration::from_millis(200));
        assert!(!reading.is_finished(), "case {case} waits");
        let start = Instant::now();
        interrupt.flag().store(true, Ordering::Relaxed);
        assert!(matches!(reading.join().unwrap(), FootageError::Interrupted), "case {case}");
        assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
        let whole = i32::from(written.is_some_and(|length| length > 3000));
        assert_eq!(told.recv().unwrap(), whole, "case {case}");
        drop(writer);
    }
}

#[test]
fn a_wait_for_the_times_of_images_ends_on_request() {
    let dir = tempfile::tempdir().unwrap();
    let image = dir.path().join("a.pgm");
    fs::write(&image, "P2 2 1 255 1 2\n").unwrap();
    let times = fifo(dir.path(), "times");
    let file = TimestampsFile { path: times, unit: TimestampUnit::Seconds };
    let options = InputOptions { timestamps: Some(file), ..InputOptions::default() };
    let interrupt = options.interrupt.clone();
    let reading = std::thread::spawn(move || opened(&image, 8, &options).err().unwrap());
    std::thread::sleep(Duration::from_millis(200));
    assert!(!reading.is_finished());
    interrupt.flag().store(true, Ordering::Relaxed);
    assert!(matches!(reading.join().unwrap(), FootageError::Interrupted));
}
