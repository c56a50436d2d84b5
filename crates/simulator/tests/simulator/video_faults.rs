// SPDX-License-Identifier: MIT OR Apache-2.0
//! A damaged video gives the frames that can be decoded and is reported. A file that is not a video
//! is refused. Without ffmpeg the tests are skipped with a message.

use std::fs;

use crate::support::clips::{all, clip, ffmpeg, frames, opened, tools};
use crate::support::run;
use foveate_footage::{FootageError, FrameSelection, InputOptions};
use foveate_simulator::RunOptions;

#[test]
fn a_truncated_video_gives_what_could_be_decoded_and_says_so() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for (name, more) in [
        ("a.mp4", &["-pix_fmt", "yuv420p", "-movflags", "+faststart"][..]),
        ("a.mkv", &["-c:v", "mpeg4"]),
        ("a.avi", &["-c:v", "mpeg4"]),
    ] {
        let path = clip(dir.path(), name, more);
        let whole = fs::read(&path).unwrap();
        let cut = dir.path().join(format!("cut-{name}"));
        for tenths in [5, 7, 9] {
            fs::write(&cut, &whole[..whole.len() * tenths / 10]).unwrap();
            let (seen, problem) = all(&cut);
            assert!((10..100).contains(&seen.len()), "{name} {tenths}: {} frames", seen.len());
            let problem = problem.unwrap();
            assert!(!problem.is_empty() && !problem.contains('\n'), "{problem}");
        }
        let output = dir.path().join(format!("out-{name}"));
        let summary = run(&[&cut], &[], &output, &RunOptions::default()).unwrap();
        assert!(!summary.complete && summary.problem.is_some() && summary.frames > 10);
        let written = fs::read_to_string(output.join("summary.json")).unwrap();
        assert!(written.contains("\"complete\": false"));
    }
}

#[test]
fn a_damaged_video_is_not_complete() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let path = clip(dir.path(), "a.avi", &["-c:v", "mpeg4"]);
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle..middle + 2000].fill(0x55);
    fs::write(&path, bytes).unwrap();
    let (seen, problem) = all(&path);
    assert!(seen.len() > 40 && problem.unwrap().starts_with("ffmpeg reports"));
}

#[test]
fn a_change_of_size_ends_the_clip_unless_frames_are_scaled() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let mut joined = Vec::new();
    for size in ["64x48", "80x64"] {
        let part = dir.path().join(format!("{size}.ts"));
        let source = format!("testsrc=size={size}:rate=25:duration=1");
        ffmpeg(&["-f", "lavfi", "-i", &source, "-c:v", "mpeg2video", part.to_str().unwrap()]);
        joined.extend(fs::read(part).unwrap());
    }
    let path = dir.path().join("joined.ts");
    fs::write(&path, joined).unwrap();
    let (seen, problem) = all(&path);
    assert!((20..=25).contains(&seen.len()), "{}", seen.len());
    let problem = problem.unwrap();
    assert!(problem.contains("from 64x48 to 80x64 at"), "{problem}");
    let scaled = InputOptions { resize: Some((32, 24)), ..InputOptions::default() };
    assert!(frames(&path, 8, &scaled).0.len() > 40);
}

#[test]
fn what_holds_no_video_is_refused_in_one_line() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::write(at("text.mp4"), "no video").unwrap();
    fs::write(at("empty.mp4"), "").unwrap();
    fs::write(at("real.gif"), b"GIF89a\x01\x00\x01\x00\x00\x00\x00;").unwrap();
    ffmpeg(&["-f", "lavfi", "-i", "sine=duration=1", at("sound.wav").to_str().unwrap()]);
    let whole = fs::read(clip(dir.path(), "a.mp4", &["-pix_fmt", "yuv420p"])).unwrap();
    // An MP4 cannot be decoded without its index, which comes last.
    fs::write(at("cut.mp4"), &whole[..whole.len() / 2]).unwrap();
    for name in ["text.mp4", "empty.mp4", "real.gif", "sound.wav", "cut.mp4"] {
        let error = opened(&at(name), 8, &InputOptions::default()).err().unwrap();
        let message = error.to_string();
        assert!(
            matches!(error, FootageError::Video { .. } | FootageError::Frameless { .. }),
            "{message}"
        );
        assert!(message.contains(name) && !message.contains('\n'), "{message}");
    }
    let late = FrameSelection { start_us: Some(100_000_000), ..FrameSelection::default() };
    let late = InputOptions { selection: late, ..InputOptions::default() };
    fs::write(at("whole.mp4"), whole).unwrap();
    let error = opened(&at("whole.mp4"), 8, &late).err().unwrap();
    assert!(error.to_string().contains("(as selected) holds no frame"), "{error}");
}

#[test]
fn names_are_files_and_nothing_else() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let path = clip(dir.path(), "a.mkv", &["-c:v", "ffv1", "-frames:v", "2"]);
    for name in ["-i.mkv", "concat:x|y.mkv", "100%d.mkv", "a b'c.mkv", "http:x.mkv"] {
        let odd = dir.path().join(name);
        fs::copy(&path, &odd).unwrap();
        assert_eq!(all(&odd).0.len(), 2, "{name}");
    }
}
