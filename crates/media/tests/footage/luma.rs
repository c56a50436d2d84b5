// SPDX-License-Identifier: MIT OR Apache-2.0
//! The range of luma: coded values by default, and on request those that other programs make of
//! them.

use std::fs;
use std::path::Path;

use crate::clips::{clip, ffmpeg, frames, opened, tools};
use foveate_media::{InputOptions, LumaRange};

fn pixels(path: &Path, bits: u32, luma: LumaRange) -> Vec<u16> {
    let options = InputOptions { luma, ..InputOptions::default() };
    let (seen, problem) = frames(path, bits, &options);
    assert_eq!(problem, None);
    seen.iter().flat_map(|seen| seen.frame.borrowed_pixels().to_words()).collect()
}

/// Returns the frames as ffmpeg expands them, with 8 or 16 bits.
fn expanded_by_ffmpeg(path: &Path, format: &str) -> Vec<u16> {
    let raw = path.with_extension("raw");
    let shown = [path.to_str().unwrap(), raw.to_str().unwrap()];
    ffmpeg(&[
        "-i",
        shown[0],
        "-vf",
        "scale=out_range=full",
        "-pix_fmt",
        format,
        "-f",
        "rawvideo",
        shown[1],
    ]);
    let bytes = fs::read(&raw).unwrap();
    match format {
        "gray" => bytes.into_iter().map(u16::from).collect(),
        _ => bytes.chunks(2).map(|word| u16::from_le_bytes([word[0], word[1]])).collect(),
    }
}

/// Returns the largest difference of two lists.
fn largest_difference(one: &[u16], other: &[u16]) -> u16 {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).map(|(one, other)| one.abs_diff(*other)).max().unwrap()
}

#[test]
fn the_full_range_is_that_of_ffmpeg() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let of = |name: &str, more: &[&str]| clip(dir.path(), name, more);
    let narrow = of("narrow.mkv", &["-c:v", "ffv1", "-pix_fmt", "yuv420p", "-t", "0.2"]);
    let y4m = of("narrow.y4m", &["-pix_fmt", "yuv420p", "-t", "0.2"]);
    for path in [&narrow, &y4m] {
        let (coded, full) = (pixels(path, 8, LumaRange::Coded), pixels(path, 8, LumaRange::Full));
        let ends = |pixels: &[u16]| (*pixels.iter().min().unwrap(), *pixels.iter().max().unwrap());
        assert!(ends(&coded).0 >= 16 && ends(&coded).1 <= 235, "{:?}", ends(&coded));
        assert_eq!(ends(&full), (0, 255));
        assert!(largest_difference(&coded, &full) > 10);
        assert!(largest_difference(&full, &expanded_by_ffmpeg(path, "gray")) <= 1, "{path:?}");
    }
    // More bits are expanded before they are cut. The white of ffmpeg is 1020 of 10 bits, and
    // not 1023.
    let deep = of("deep.mkv", &["-c:v", "ffv1", "-pix_fmt", "yuv420p10le", "-t", "0.2"]);
    let full = pixels(&deep, 10, LumaRange::Full);
    let other = expanded_by_ffmpeg(&deep, "gray10le");
    assert!(largest_difference(&full, &other) <= 4, "{}", largest_difference(&full, &other));
    let cut: Vec<u16> = pixels(&deep, 10, LumaRange::Full).iter().map(|pixel| pixel >> 2).collect();
    assert_eq!(cut, pixels(&deep, 8, LumaRange::Full));
}

#[test]
fn video_with_all_values_is_not_changed() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for (name, more) in [
        (
            "tagged.mkv",
            &[
                "-vf",
                "scale=out_range=full",
                "-color_range",
                "pc",
                "-c:v",
                "ffv1",
                "-pix_fmt",
                "yuv420p",
            ][..],
        ),
        ("jpeg.mov", &["-c:v", "mjpeg", "-pix_fmt", "yuvj420p"]),
        ("grey.mkv", &["-c:v", "ffv1", "-pix_fmt", "gray"]),
        ("colours.mkv", &["-c:v", "ffv1", "-pix_fmt", "bgr0"]),
        ("grey.y4m", &["-pix_fmt", "gray"]),
        ("tagged_grey.mkv", &["-color_range", "tv", "-c:v", "ffv1", "-pix_fmt", "gray"]),
        ("tagged_grey.y4m", &["-color_range", "tv", "-pix_fmt", "gray"]),
        (
            "tagged.y4m",
            &["-vf", "scale=out_range=full", "-color_range", "pc", "-pix_fmt", "yuv420p"],
        ),
    ] {
        let path = clip(dir.path(), name, &[more, &["-t", "0.2"]].concat());
        let [coded, full] = [LumaRange::Coded, LumaRange::Full].map(|luma| pixels(&path, 8, luma));
        assert!(coded == full, "{name}");
    }
}

#[test]
fn a_source_names_its_range() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.y4m");
    let frame = [b"FRAME\n".as_slice(), &[16; 96]].concat();
    fs::write(&path, [b"YUV4MPEG2 W8 H8 C420 XCOLORRANGE=LIMITED\n".as_slice(), &frame].concat())
        .unwrap();
    for luma in [LumaRange::Coded, LumaRange::Full] {
        let options = InputOptions { luma, ..InputOptions::default() };
        assert_eq!(opened(&path, 8, &options).unwrap().luma(), Some(luma));
        let scene = opened(Path::new("scene:street"), 8, &options).unwrap();
        assert_eq!(scene.luma(), None);
    }
    assert_eq!(pixels(&path, 8, LumaRange::Full), [0; 64]);
    assert_eq!(pixels(&path, 8, LumaRange::Coded), [16; 64]);
    let options = InputOptions { luma: LumaRange::Full, ..InputOptions::default() };
    let camera =
        opened(Path::new("rtsp://127.0.0.1:9/none"), 8, &options).err().unwrap().to_string();
    assert!(camera.contains("--luma full") && camera.contains("not known"), "{camera}");
}
