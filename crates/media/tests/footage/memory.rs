// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames in memory are read in the same way as a file with these frames.

use std::path::PathBuf;

use foveate_camera::CameraConfig;
use foveate_media::{
    CropRect, FrameRate, FrameSource, ImageRelation, InputOptions, SourceKind, open,
    source_from_memory,
};
use foveate_pixels::ByteFrame;

const SIZE: (u32, u32) = (9, 6);

fn frames() -> Vec<ByteFrame> {
    let pixels = |frame: u8| (0..54).map(|at| at * 3 + frame * 17).collect();
    (0..6).map(|frame| ByteFrame::from_bytes(SIZE.0, SIZE.1, 8, pixels(frame)).unwrap()).collect()
}

fn all(mut source: Box<dyn FrameSource>) -> Vec<(u64, ByteFrame)> {
    std::iter::from_fn(|| source.next_frame().unwrap())
        .map(|frame| (frame.time_us, frame.frame))
        .collect()
}

#[test]
fn options_are_those_of_files() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("clip.y4m");
    let mut bytes = b"YUV4MPEG2 W9 H6 Cmono\n".to_vec();
    for frame in frames() {
        bytes.extend(b"FRAME\n");
        bytes.extend(
            frame
                .borrowed_pixels()
                .to_words()
                .into_iter()
                .map(|pixel| u8::try_from(pixel).unwrap()),
        );
    }
    std::fs::write(&path, bytes).unwrap();
    let rate = FrameRate::new(25, 1).unwrap();
    let plain = InputOptions { frame_rate: rate, ..InputOptions::default() };
    let mut late = plain.clone();
    late.selection.start_us = Some(80_000);
    let few = InputOptions { frames: Some(2), ..plain.clone() };
    let part = InputOptions {
        crop: Some(CropRect { size: (6, 4), origin: (2, 1) }),
        resize: Some((3, 2)),
        ..plain.clone()
    };
    for (options, count) in [(plain, 6), (late, 4), (few, 2), (part, 6)] {
        let expected = all(open(&[&path], &CameraConfig::default(), &options).unwrap());
        let found = all(source_from_memory("array", frames(), &options).unwrap());
        assert_eq!((found.len(), found), (count, expected));
    }
}

#[test]
fn a_set_has_no_times_and_what_belongs_to_files_is_refused() {
    let set = InputOptions { images: ImageRelation::Set, ..InputOptions::default() };
    let mut source = source_from_memory("array", frames(), &set).unwrap();
    assert_eq!((source.kind(), source.frames(), source.size()), (SourceKind::Set, Some(6), SIZE));
    source.next_frame().unwrap();
    let second = source.next_frame().unwrap().unwrap();
    assert_eq!((second.name.as_str(), second.time_us), ("array[1]", 0));
    let refused = |frames, options: &InputOptions| {
        source_from_memory("array", frames, options).map(|_| ()).unwrap_err().to_string()
    };
    let sheet = InputOptions { images: ImageRelation::CifarSheet, ..InputOptions::default() };
    assert!(
        refused(frames(), &sheet).contains("CIFAR sheets are files, but `array` is not a file")
    );
    let labels = InputOptions { labels: Some(PathBuf::from("l")), ..InputOptions::default() };
    assert!(refused(frames(), &labels).contains("labelled images are files"));
    let none = refused(Vec::new(), &InputOptions::default());
    assert_eq!(none, "array holds no frame; at least one is needed");
}
