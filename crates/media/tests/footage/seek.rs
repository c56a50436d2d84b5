// SPDX-License-Identifier: MIT OR Apache-2.0
//! A late start gives the same frames and times as decoding from the beginning, and ffmpeg ends as
//! soon as it is no longer needed.

use std::path::Path;

use crate::clips::{all, ffmpeg, frames, opened, tools};
use foveate_media::{CropRect, FrameOrigin, FrameRate, FrameSelection, InputOptions};
use foveate_tools::testing::sample;

/// Makes a clip of 200 frames at 25 per second. Its first second is already larger than a pipe's
/// buffer.
fn moving(folder: &Path, name: &str, more: &[&str]) -> std::path::PathBuf {
    let path = folder.join(name);
    let source = ["-f", "lavfi", "-i", "testsrc2=size=160x120:rate=25:duration=8"];
    ffmpeg(&[&source[..], more, &[path.to_str().unwrap()]].concat());
    path
}

fn from(start_us: u64) -> InputOptions {
    let selection = FrameSelection { start_us: Some(start_us), ..FrameSelection::default() };
    InputOptions { selection, ..InputOptions::default() }
}

/// Returns the arguments of every ffmpeg that is reading `path`.
#[cfg(target_os = "linux")]
fn decoders(path: &Path) -> Vec<String> {
    let processes = std::fs::read_dir("/proc").unwrap();
    let commands = processes.filter_map(|entry| {
        let bytes = std::fs::read(entry.ok()?.path().join("cmdline")).ok()?;
        Some(String::from_utf8_lossy(&bytes).replace('\0', " "))
    });
    commands.filter(|c| c.contains("showinfo") && c.contains(path.to_str().unwrap())).collect()
}

#[test]
fn a_late_start_changes_nothing_but_where_it_starts() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let h264 =
        ["-c:v", "libx264", "-preset", "ultrafast", "-pix_fmt", "yuv420p", "-bf", "3", "-g", "20"];
    let with = |more: &[&'static str]| [&h264[..], more].concat();
    let sound = ["-f", "lavfi", "-i", "sine=duration=9", "-c:a", "aac", "-af", "asetpts=PTS+1/TB"];
    let clips = [
        ("b.mp4", h264.to_vec(), true),
        ("b.mkv", h264.to_vec(), true),
        ("b.mov", h264.to_vec(), true),
        ("late.mp4", with(&["-output_ts_offset", "3"]), true),
        ("late.mkv", with(&["-output_ts_offset", "3"]), true),
        ("sound.mp4", [&sound[..], &h264].concat(), true),
        ("open.mp4", with(&["-x264-params", "open-gop=1:scenecut=0"]), false),
        ("refresh.mp4", with(&["-x264-params", "intra-refresh=1"]), false),
        ("long.mp4", with(&["-g", "1000", "-sc_threshold", "0"]), true),
        ("jpeg.mkv", vec!["-c:v", "mjpeg", "-q:v", "3"], true),
        ("b.avi", vec!["-c:v", "mpeg4", "-bf", "2"], false),
        ("b.ts", h264.to_vec(), false),
        ("2.mp4", vec!["-c:v", "mpeg4", "-bf", "2"], false),
    ];
    for (turn, (name, arguments, sought)) in sample(clips.into_iter().enumerate(), 5) {
        let path = moving(dir.path(), name, &arguments);
        let whole = all(&path).0;
        assert!(whole.len() >= 195, "{name}");
        // Each clip tests one of the four start times, because every test decodes most of the clip.
        let start = [3_000_000, 5_010_000, 6_480_000, 7_900_000][turn % 4];
        let expected = whole.iter().filter(|frame| frame.time_us >= start);
        let seen = frames(&path, 8, &from(start)).0;
        assert_eq!(seen.len(), expected.clone().count(), "{name} from {start}");
        for (seen, expected) in seen.iter().zip(expected) {
            assert_eq!(seen.time_us, expected.time_us, "{name} from {start}");
            assert!(seen.frame == expected.frame, "{name} from {start} at {}", seen.time_us);
        }
        assert!(opened(&path, 8, &from(20_000_000)).is_err(), "{name}: nothing is there");
        #[cfg(target_os = "linux")]
        if sought {
            let source = opened(&path, 8, &from(3_000_000)).unwrap();
            let running = decoders(&path);
            assert!(running.len() == 1 && running[0].contains(" -ss "), "{name}: {running:?}");
            drop(source);
        }
    }
}

#[test]
fn frames_are_numbered_whatever_is_taken() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let path =
        moving(dir.path(), "a.mp4", &["-c:v", "libx264", "-preset", "ultrafast", "-g", "20"]);
    let rate = Some(FrameRate::new(5, 1).unwrap());
    let selection = FrameSelection { start_us: Some(5_000_000), end_us: Some(5_700_000), rate };
    let crop = Some(CropRect { size: (64, 48), origin: (8, 8) });
    let resize = Some((32, 24));
    let options =
        InputOptions { selection, crop, resize, numbered: true, ..InputOptions::default() };
    let mut source = opened(&path, 8, &options).unwrap();
    assert_eq!(source.origin(), None, "no frame was given");
    let mut origins = Vec::new();
    while source.next_frame().unwrap().is_some() {
        origins.extend(source.origin());
    }
    let expected = [125, 130, 135, 140].map(|number| FrameOrigin {
        number,
        size: (160, 120),
        own_file: false,
    });
    assert_eq!(origins, expected);
}

#[cfg(target_os = "linux")]
#[test]
fn ffmpeg_ends_with_the_last_frame_that_is_wanted() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let path = moving(dir.path(), "a.mkv", &["-c:v", "mjpeg"]);
    let limit = InputOptions { frames: Some(3), ..InputOptions::default() };
    let end = FrameSelection { end_us: Some(120_000), ..FrameSelection::default() };
    let end = InputOptions { selection: end, ..InputOptions::default() };
    for options in [limit, end] {
        let mut source = opened(&path, 8, &options).unwrap();
        assert_eq!(decoders(&path).len(), 1);
        let mut count = 0;
        while source.next_frame().unwrap().is_some() {
            count += 1;
        }
        assert_eq!((count, source.problem()), (3, None));
        assert!(decoders(&path).is_empty(), "it is still there");
    }
}
