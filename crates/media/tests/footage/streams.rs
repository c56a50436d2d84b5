// SPDX-License-Identifier: MIT OR Apache-2.0
//! The video stream that is read of a file with several, and times that go back.

use std::fs;
use std::path::{Path, PathBuf};

use crate::clips::{clip, ffmpeg, opened, tools};
use foveate_media::{FrameRate, FrameSelection, InputOptions};
use foveate_tools::testing::data_folder;

/// The size, the times of all frames, the problem and the warnings of a file.
struct ClipContent {
    size: (u32, u32),
    times: Vec<u64>,
    problem: Option<String>,
    warnings: Vec<String>,
}

fn read(path: &Path, options: &InputOptions) -> Result<ClipContent, String> {
    let mut source = opened(path, 8, options).map_err(|error| error.to_string())?;
    let mut times = Vec::new();
    while let Some(frame) = source.next_frame().map_err(|error| error.to_string())? {
        times.push(frame.time_us);
    }
    let (size, problem) = (source.size(), source.problem());
    Ok(ClipContent { size, times, problem, warnings: options.warnings.take() })
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Joins the streams of several files, which may be marked.
fn joined(folder: &Path, name: &str, inputs: &[&Path], marks: &[&str]) -> PathBuf {
    let path = folder.join(name);
    let numbers: Vec<String> = (0..inputs.len()).map(|number| number.to_string()).collect();
    let mut args: Vec<&str> = inputs.iter().flat_map(|input| ["-i", text(input)]).collect();
    args.extend(numbers.iter().flat_map(|number| ["-map", number.as_str()]));
    args.extend(["-c", "copy"].iter().chain(marks));
    ffmpeg(&[&args[..], &[text(&path)]].concat());
    path
}

#[test]
fn pictures_beside_the_video_are_not_the_clip() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    let video = clip(folder, "v.mp4", &["-c:v", "libx264", "-pix_fmt", "yuv420p", "-t", "1"]);
    let picture = folder.join("c.jpg");
    ffmpeg(&["-f", "lavfi", "-i", "testsrc=size=64x64", "-frames:v", "1", text(&picture)]);
    let sound = folder.join("s.m4a");
    ffmpeg(&["-f", "lavfi", "-i", "sine=duration=1", "-c:a", "aac", text(&sound)]);
    let attached = ["-disposition:v:0", "attached_pic"];
    for (name, marks) in [
        ("still.mp4", &[][..]),
        ("still.mkv", &["-disposition:v:1", "default"]),
        ("cover.mkv", &attached),
    ] {
        let path = joined(folder, name, &[&picture, &video], marks);
        let clip = read(&path, &InputOptions::default()).unwrap();
        assert_eq!((clip.size, clip.times.len(), clip.problem), ((80, 60), 25, None), "{name}");
    }
    if let Some(path) = data_folder().map(|data| data.join("cases/cover_first.mp4")) {
        let clip = read(&path, &InputOptions::default()).unwrap();
        assert_eq!((clip.size, clip.times.len()), ((160, 120), 25));
        assert_eq!((clip.problem, clip.warnings), (None, vec![]));
    }
    let covered = joined(folder, "covered.m4a", &[&picture, &sound], &attached);
    let problem = read(&covered, &InputOptions::default()).map(|clip| clip.size).unwrap_err();
    assert!(problem.contains("no video, only pictures"), "{problem}");
    let wished = InputOptions { video_stream: Some(0), ..InputOptions::default() };
    assert_eq!(read(&covered, &wished).unwrap().times, [0]);
    // The advice of a video made of an MP3 would be a clip of its cover.
    let mp3 = folder.join("s.mp3");
    ffmpeg(&["-i", text(&sound), "-c:a", "libmp3lame", text(&mp3)]);
    let problem = read(&mp3, &InputOptions::default()).map(|clip| clip.size).unwrap_err();
    assert!(problem.contains("sound") && !problem.contains("ffmpeg -i"), "{problem}");
}

#[test]
fn the_default_stream_is_read_and_the_others_are_named() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let small = clip(dir.path(), "v.mkv", &["-c:v", "ffv1", "-t", "1"]);
    let large = dir.path().join("large.mkv");
    let source = "testsrc=size=160x120:rate=10:duration=1";
    ffmpeg(&["-f", "lavfi", "-i", source, "-c:v", "ffv1", text(&large)]);
    for (marks, expected) in [
        (&["-disposition:v:0", "0", "-disposition:v:1", "default"][..], (160, 120)),
        (&["-disposition:v:0", "default", "-disposition:v:1", "0"], (80, 60)),
        (&["-disposition:v:0", "0", "-disposition:v:1", "0"], (80, 60)),
    ] {
        let path = joined(dir.path(), "two.mkv", &[&small, &large], marks);
        let clip = read(&path, &InputOptions::default()).unwrap();
        assert_eq!(clip.size, expected, "{marks:?}");
        let [warning] = &clip.warnings[..] else { panic!("{:?}", clip.warnings) };
        assert!(warning.contains("2 video streams: 0 (ffv1, 80x60"), "{warning}");
        assert!(warning.contains("1 (ffv1, 160x120"), "{warning}");
        for (number, size, frames) in [(0, (80, 60), 25), (1, (160, 120), 10)] {
            let options = InputOptions { video_stream: Some(number), ..InputOptions::default() };
            let clip = read(&path, &options).unwrap();
            assert_eq!((clip.size, clip.times.len(), clip.warnings), (size, frames, vec![]));
        }
        let options = InputOptions { video_stream: Some(2), ..InputOptions::default() };
        let problem = read(&path, &options).map(|clip| clip.size).unwrap_err();
        assert!(problem.contains("no video stream 2; it has 0 (ffv1, 80x60"), "{problem}");
    }
}

/// Each kind of join leaves a place where the times of the container go back.
#[test]
fn a_clock_that_goes_back_goes_on() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let mut clips = Vec::new();
    for (name, codec) in [("a.webm", "libvpx"), ("a.mkv", "mpeg4")] {
        let part = clip(dir.path(), name, &["-c:v", codec, "-t", "1"]);
        let twice = dir.path().join(format!("twice_{name}"));
        fs::write(&twice, fs::read(&part).unwrap().repeat(2)).unwrap();
        clips.push((twice, 25));
    }
    if let Some(path) = data_folder().map(|data| data.join("cases/cat.webm")) {
        clips.push((path, 50));
    }
    for (path, part) in clips {
        let name = path.display();
        let clip = read(&path, &InputOptions::default()).unwrap();
        let expected: Vec<u64> = (0..2 * part).map(|frame| frame * 40_000).collect();
        assert_eq!((clip.times.len(), clip.problem), (expected.len(), None), "{name}");
        for (seen, expected) in clip.times.iter().zip(&expected) {
            assert!(seen.abs_diff(*expected) <= 1000, "{name}: {seen}, not {expected}");
        }
        let [warning] = &clip.warnings[..] else { panic!("{name}: {:?}", clip.warnings) };
        let frame = format!("go back once, first at frame {part}:");
        assert!(warning.contains(&frame) && warning.contains("to 0.000000 s"), "{warning}");
        let selection = FrameSelection {
            rate: Some(FrameRate::parse("5").unwrap()),
            ..FrameSelection::default()
        };
        let options = InputOptions { selection, ..InputOptions::default() };
        let expected = usize::try_from(2 * part / 5).unwrap();
        assert_eq!(read(&path, &options).unwrap().times.len(), expected, "{name} at 5 per second");
    }
}

/// A time of the container is that of several frames here, so a late start is none by that time.
#[test]
fn a_late_start_follows_the_clock_that_goes_on() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for (name, live) in [("file.mkv", "0"), ("live.mkv", "1")] {
        let images = ["-c:v", "mjpeg", "-pix_fmt", "yuvj420p", "-live", live];
        let part = fs::read(clip(dir.path(), name, &images)).unwrap();
        let twice = dir.path().join(format!("twice_{name}"));
        fs::write(&twice, part.repeat(2)).unwrap();
        let selection = FrameSelection { start_us: Some(5_000_000), ..FrameSelection::default() };
        let seen = read(&twice, &InputOptions { selection, ..InputOptions::default() }).unwrap();
        assert_eq!((seen.times.len(), seen.problem), (75, None), "{name}");
        assert_eq!(seen.times[0], 5_000_000, "{name}");
    }
}

/// A stream of images has all frames, whatever its name is, and is refused among other images.
#[test]
fn images_behind_each_other_are_a_stream() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for (codec, names) in [
        ("mjpeg", &["a.mjpeg", "a.mjpg", "a.jpg", "a"][..]),
        ("png", &["a.png"]),
        ("bmp", &["a.bmp"]),
    ] {
        let stream = dir.path().join(codec);
        let source = ["-f", "lavfi", "-i", "testsrc=size=80x60:rate=25:duration=1"];
        let codec = ["-c:v", codec, "-huffman", "default", "-f", "image2pipe"];
        let codec = if codec[1] == "mjpeg" {
            &codec[..]
        } else {
            &[codec[0], codec[1], "-f", "image2pipe"]
        };
        ffmpeg(&[&source[..], codec, &[text(&stream)]].concat());
        let bytes = fs::read(&stream).unwrap();
        for name in names {
            let folder = dir.path().join(format!("in_{name}"));
            fs::create_dir(&folder).unwrap();
            let path = folder.join(name);
            fs::write(&path, &bytes).unwrap();
            let clip = read(&path, &InputOptions::default()).unwrap();
            let expected: Vec<u64> = (0..25).map(|frame| frame * 40_000).collect();
            assert_eq!((clip.size, clip.times, clip.problem), ((80, 60), expected, None), "{name}");
            if name.contains('.') && !name.contains("mj") {
                let other = folder.join(name.replace('.', "2."));
                fs::write(&other, &bytes).unwrap();
                let problem = read(&folder, &InputOptions::default()).map(|clip| clip.size);
                assert!(problem.unwrap_err().contains("holds several frames"), "{name}");
            }
        }
        if codec[1] == "mjpeg" {
            let path = dir.path().join("bare.mjpeg");
            fs::write(&path, without_huffman_tables(&bytes)).unwrap();
            assert_eq!(read(&path, &InputOptions::default()).unwrap().times.len(), 25);
        }
    }
    if let Some(path) = data_folder().map(|data| data.join("cases/a.mjpeg")) {
        assert_eq!(read(&path, &InputOptions::default()).unwrap().times.len(), 50);
    }
}

/// Leaves out the Huffman tables of a stream of JPEG, as many cameras do.
fn without_huffman_tables(bytes: &[u8]) -> Vec<u8> {
    let mut left = Vec::new();
    let mut rest = bytes;
    while let Some(at) = rest.windows(2).position(|pair| pair == [0xFF, 0xC4]) {
        left.extend_from_slice(&rest[..at]);
        let length = usize::from(u16::from_be_bytes([rest[at + 2], rest[at + 3]]));
        rest = &rest[at + 2 + length..];
    }
    left.extend_from_slice(rest);
    left
}
