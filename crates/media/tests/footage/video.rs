// SPDX-License-Identifier: MIT OR Apache-2.0
//! Video through ffmpeg gives every coded frame once, with the container's time and the coded luma.
//! The clips are made by ffmpeg; without it the tests are skipped with a message.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::clips::{all, clip, ffmpeg, frames, opened, tools};
use foveate_media::{CropRect, FrameRate, FrameSelection, InputOptions, SourceFrame};
use foveate_pixels::{convert_depth, luma};
use foveate_tools::testing::{data_folder, sample};

/// Returns the times that ffprobe reports for every frame, in microseconds since the first.
fn probed_times(path: &Path) -> Vec<u64> {
    let output = Command::new("ffprobe")
        .args(["-v", "error", "-select_streams", "v:0", "-show_entries"])
        .args(["frame=pts:stream=time_base", "-of", "csv"])
        .arg(path)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let value = |line: &str| line.split(',').nth(1).unwrap().trim().to_owned();
    let base = text.lines().find(|line| line.starts_with("stream,")).map(value).unwrap();
    let (numerator, denominator) = base.split_once('/').unwrap();
    let (numerator, denominator): (i128, i128) =
        (numerator.parse().unwrap(), denominator.parse().unwrap());
    let pts: Vec<i128> = text
        .lines()
        .filter(|line| line.starts_with("frame,"))
        .map(|line| value(line).parse().unwrap())
        .collect();
    let micros = |pts: &i128| {
        ((pts - pts_first(&text)) * numerator * 1_000_000 + denominator / 2) / denominator
    };
    pts.iter().map(|pts| u64::try_from(micros(pts)).unwrap()).collect()
}

fn pts_first(text: &str) -> i128 {
    let line = text.lines().find(|line| line.starts_with("frame,")).unwrap();
    line.split(',').nth(1).unwrap().trim().parse().unwrap()
}

fn times(frames: &[SourceFrame]) -> Vec<u64> {
    frames.iter().map(|frame| frame.time_us).collect()
}

#[test]
fn every_container_gives_every_frame_with_its_time() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    // The times are uneven: two of five frames are left out.
    let uneven = ["-vf", "select=not(eq(mod(n\\,5)\\,2))*not(eq(mod(n\\,5)\\,3))", "-vsync", "0"];
    for (name, codec) in [
        ("a.mp4", "libx264"),
        ("a.mkv", "ffv1"),
        ("a.webm", "libvpx"),
        ("a.ts", "mpeg2video"),
        ("a.mov", "mjpeg"),
    ] {
        let path = clip(dir.path(), name, &["-c:v", codec, "-pix_fmt", pixel_format(codec)]);
        let (seen, problem) = all(&path);
        assert_eq!((seen.len(), problem), (100, None), "{name}");
        assert_eq!(times(&seen), probed_times(&path), "{name}");
    }
    let path = clip(dir.path(), "uneven.mkv", &[&uneven[..], &["-c:v", "ffv1"]].concat());
    let (seen, problem) = all(&path);
    assert_eq!((seen.len(), problem), (60, None));
    assert_eq!(times(&seen)[..4], [0, 40_000, 160_000, 200_000]);
    assert_eq!(times(&seen), probed_times(&path));
}

fn pixel_format(codec: &str) -> &'static str {
    if codec == "mjpeg" { "yuvj420p" } else { "yuv420p" }
}

#[test]
fn luma_is_the_coded_plane_whatever_way_it_comes() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let formats = ["yuv420p", "yuv422p", "yuv444p", "yuv420p10le", "gray", "gray10le", "nv12"];
    for (turn, format) in sample(formats.into_iter().enumerate(), 3) {
        let lossless = ["-c:v", "rawvideo", "-pix_fmt", format, "-frames:v", "5"];
        let path = clip(dir.path(), &format!("{format}.nut"), &lossless);
        let raw = dir.path().join("raw");
        let planar = if format == "nv12" { "yuv420p" } else { format };
        let as_coded = ["-i", path.to_str().unwrap(), "-pix_fmt", planar, "-f", "rawvideo"];
        ffmpeg(&[&as_coded[..], &[raw.to_str().unwrap()]].concat());
        let bytes = fs::read(&raw).unwrap();
        let deep = format.contains("10");
        let (depth, size) = if deep { (10, 2) } else { (8, 1) };
        for bits in [[8, 16], [4, 10]][turn % 2] {
            let (seen, problem) = frames(&path, bits, &InputOptions::default());
            assert_eq!((seen.len(), problem), (5, None), "{format}");
            for (frame, raw) in seen.iter().zip(bytes.chunks(bytes.len() / 5)) {
                let luma = raw.chunks(size).take(80 * 60).map(|sample| match *sample {
                    [low, high] => u16::from_le_bytes([low, high]),
                    _ => u16::from(sample[0]),
                });
                let expected: Vec<u16> = luma.map(|v| convert_depth(v, depth, bits)).collect();
                assert_eq!(
                    frame.frame.borrowed_pixels().to_words(),
                    expected,
                    "{format} at {bits} bits"
                );
            }
        }
        if format != "nv12" {
            let y4m = dir.path().join("same.y4m");
            let to_y4m = ["-i", path.to_str().unwrap(), "-strict", "-1", "-f", "yuv4mpegpipe"];
            ffmpeg(&[&to_y4m[..], &[y4m.to_str().unwrap()]].concat());
            let pixels = |path: &Path| -> Vec<_> {
                frames(path, 10, &InputOptions::default()).0.into_iter().map(|f| f.frame).collect()
            };
            assert!(pixels(&y4m) == pixels(&path), "{format} by way of YUV4MPEG2");
        }
    }
}

#[test]
fn rgb_video_is_mixed_as_images_are() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let path = clip(dir.path(), "rgb.mkv", &["-c:v", "ffv1", "-pix_fmt", "bgr0", "-frames:v", "3"]);
    let pictures = dir.path().join("%d.png");
    ffmpeg(&["-i", path.to_str().unwrap(), "-pix_fmt", "rgb24", pictures.to_str().unwrap()]);
    let (seen, _) = all(&path);
    for (number, frame) in (1..).zip(&seen) {
        let png = image::open(dir.path().join(format!("{number}.png"))).unwrap().into_rgb8();
        let mix = |p: &image::Rgb<u8>| luma(p.0[0].into(), p.0[1].into(), p.0[2].into());
        assert_eq!(
            frame.frame.borrowed_pixels().to_words(),
            png.pixels().map(mix).collect::<Vec<_>>()
        );
    }
    assert_eq!(seen.len(), 3);
}

#[test]
fn frames_are_chosen_by_their_times_and_keep_them() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let path = clip(dir.path(), "a.mp4", &["-pix_fmt", "yuv420p"]);
    let whole = all(&path).0;
    let selection = FrameSelection {
        start_us: Some(1_000_000),
        end_us: Some(3_000_000),
        rate: Some(FrameRate::new(5, 1).unwrap()),
    };
    let crop = Some(CropRect { size: (40, 30), origin: (8, 6) });
    let options =
        InputOptions { selection, crop, resize: Some((20, 15)), ..InputOptions::default() };
    let (some, problem) = frames(&path, 8, &options);
    assert_eq!(problem, None);
    assert_eq!(times(&some), (0..10).map(|t| 1_000_000 + 200_000 * t).collect::<Vec<_>>());
    // Two by two pixels become one.
    let (original, small) = (&whole[30].frame, &some[1].frame);
    assert_eq!((small.width(), small.height()), (20, 15));
    let sum: u16 =
        [(18, 10), (19, 10), (18, 11), (19, 11)].map(|(x, y)| original.get(x, y)).iter().sum();
    assert_eq!(small.get(5, 2), (sum + 2) / 4);
    let three = InputOptions { frames: Some(3), ..InputOptions::default() };
    assert_eq!(frames(&path, 8, &three).0.len(), 3);
    assert_eq!(opened(&path, 8, &InputOptions::default()).unwrap().frames(), Some(100));
}

/// Tests real clips in the folder that the environment variable FOVEATE_DATA names.
#[test]
fn real_clips_are_whole_and_have_their_times() {
    let Some(data) = data_folder() else { return };
    if !tools() {
        return;
    }
    let small = InputOptions { resize: Some((16, 16)), ..InputOptions::default() };
    let clips = [
        ("video_hard/tree.avi", 68),
        ("video_hard/brightness_change.avi", 59),
        ("video_moving/handheld_shaky.mp4", 245),
        ("video_moving/dashcam_solidWhiteRight.mp4", 221),
        ("video_static/vtest.avi", 795),
    ];
    for (name, count) in sample(clips, 3) {
        let path = data.join(name);
        let (seen, problem) = frames(&path, 8, &small);
        assert_eq!((seen.len(), problem), (count, None), "{name}");
        assert_eq!(times(&seen), probed_times(&path), "{name}");
    }
}
