// SPDX-License-Identifier: MIT OR Apache-2.0
//! Raw video without a header, against the same frames in a container that ffmpeg reads.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::clips::{clip, ffmpeg, frames, opened, tools};
use foveate_media::{InputOptions, LumaRange, RawLayout, SourceFrame};
use foveate_tools::testing::sample;

const FORMATS: [&str; 24] = [
    "gray",
    "gray10le",
    "gray12le",
    "gray14le",
    "gray16le",
    "gray10be",
    "gray12be",
    "gray14be",
    "gray16be",
    "yuv420p",
    "yuv422p",
    "yuv444p",
    "yuv420p10le",
    "yuv422p10le",
    "yuv444p10le",
    "yuv420p12le",
    "nv12",
    "nv21",
    "yuyv422",
    "uyvy422",
    "rgb24",
    "bgr24",
    "rgba",
    "bgra",
];

fn raw(layout: &str) -> InputOptions {
    InputOptions { raw: Some(RawLayout::parse(layout).unwrap()), ..InputOptions::default() }
}

fn pixels(seen: &[SourceFrame]) -> Vec<Vec<u16>> {
    seen.iter().map(|seen| seen.frame.borrowed_pixels().to_words()).collect()
}

#[test]
fn every_pixel_format_gives_the_luma_that_it_has_in_a_container() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    // An odd height, so that planes of colours are rounded up.
    let source =
        clip(dir.path(), "source.mkv", &["-vf", "scale=78:59", "-t", "0.12", "-c:v", "ffv1"]);
    for format in sample(FORMATS, 4) {
        let [raw_path, nut] = ["raw", "nut"].map(|end| dir.path().join(format!("{format}.{end}")));
        let input = source.to_str().unwrap();
        ffmpeg(&["-i", input, "-pix_fmt", format, "-f", "rawvideo", raw_path.to_str().unwrap()]);
        ffmpeg(&["-i", input, "-pix_fmt", format, "-c:v", "rawvideo", nut.to_str().unwrap()]);
        for (bits, luma) in [(8, LumaRange::Coded), (12, LumaRange::Coded), (8, LumaRange::Full)] {
            let options = InputOptions { luma, ..raw(&format!("78x59,{format}")) };
            let (found, problem) = frames(&raw_path, bits, &options);
            let plain = InputOptions { luma, ..InputOptions::default() };
            let (expected, _) = frames(&nut, bits, &plain);
            assert_eq!((problem, found.len()), (None, 3), "{format}");
            assert!(pixels(&found) == pixels(&expected), "{format}, {bits} bits, {luma:?}");
        }
    }
}

fn written(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn times_follow_from_the_rate_and_the_number_of_frames_from_the_length() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(dir.path(), "clip.bin", &[7; 3 * 12]);
    let options = raw("4x3,gray");
    assert_eq!(opened(&path, 8, &options).unwrap().frames(), Some(3));
    assert_eq!(opened(&path, 8, &options).unwrap().luma(), None);
    let (found, _) = frames(&path, 8, &options);
    let times: Vec<u64> = found.iter().map(|frame| frame.time_us).collect();
    assert_eq!(times, [0, 33_333, 66_667]);
    // A gzipped file is unpacked, and its length says nothing.
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    packed.write_all(&[7; 36]).unwrap();
    let packed = written(dir.path(), "clip.bin.gz", &packed.finish().unwrap());
    assert_eq!(opened(&packed, 8, &options).unwrap().frames(), None);
    assert_eq!(pixels(&frames(&packed, 8, &options).0), pixels(&found));
}

#[test]
fn a_file_that_ends_within_a_frame_gives_the_frames_before() {
    let dir = tempfile::tempdir().unwrap();
    for length in [1, 17, 18, 19, 35, 36, 53] {
        let path = written(dir.path(), "clip.yuv", &vec![9; length]);
        let options = raw("4x3,yuv420p");
        let whole = length / 20;
        match opened(&path, 8, &options) {
            Ok(_) => {
                let (found, problem) = frames(&path, 8, &options);
                assert_eq!(found.len(), whole);
                let problem = problem.unwrap();
                assert!(
                    problem.contains("inside a frame of 20 bytes; check the size"),
                    "{problem}"
                );
            }
            Err(error) => {
                let error = error.to_string();
                assert!(whole == 0 && error.contains("is not raw video of this kind"), "{error}");
            }
        }
    }
}

#[test]
fn inputs_that_are_not_raw_video_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let options = raw("4x3,gray");
    let error = |path: &Path| opened(path, 8, &options).err().unwrap().to_string();
    assert!(error(dir.path()).contains("--raw cannot be used"));
    assert!(error(&dir.path().join("f%d.raw")).contains("raw video is one file"));
    assert!(error(Path::new("scene:street")).contains("and `scene:street` is not"));
    assert!(error(Path::new("none.raw")).contains("does not exist"));
    let empty = written(dir.path(), "empty.raw", &[]);
    assert!(error(&empty).contains("holds no frame"));
    // Pixels may begin as a gzipped file does.
    let packed = written(dir.path(), "gz.raw", &[0x1F, 0x8B, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(pixels(&frames(&packed, 8, &options).0)[0][..2], [0x1F, 0x8B]);
    let colours = RawLayout::parse("2x2,rgb24").ok();
    let colours = InputOptions { raw: colours, luma: LumaRange::Full, ..InputOptions::default() };
    assert_eq!(opened(&packed, 8, &colours).unwrap().luma(), None);
    // The name of a raw camera file does not matter.
    let named = written(dir.path(), "a.raw", &[5; 12]);
    assert_eq!(frames(&named, 8, &options).0.len(), 1);
}
