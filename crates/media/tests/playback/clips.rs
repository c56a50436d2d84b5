// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the clips of a run: sizes, inputs that are read once, boxes and halves.

use std::fs;
use std::path::PathBuf;

use foveate_camera::CameraConfig;
use foveate_media::{
    ClipHalves, ClipReading, CommonFormat, CropRect, InputOptions, Orientation, PlaybackError,
    RunClips, RunMonitor, SilentHooks, source_from_memory, testing::RecordingHooks,
};
use foveate_pixels::{ByteFrame, Rect};

use crate::support::CountedSource;

fn camera() -> CameraConfig {
    CameraConfig::from_toml("[frame]\nwidth = 32\nheight = 16\n").unwrap()
}

fn clips(inputs: &[&str], frames: u32) -> RunClips {
    let options = InputOptions { frames: Some(frames), ..InputOptions::default() };
    let inputs: Vec<PathBuf> = inputs.iter().map(PathBuf::from).collect();
    RunClips::new(&inputs, &[], &camera(), &options).unwrap()
}

#[test]
fn clips_of_one_size_are_opened_as_often_as_they_are_read() {
    let clips = clips(&["scene:street", "scene:zero"], 5);
    for reading in [ClipReading::Once, ClipReading::Repeated] {
        let format = clips.common_format(reading).unwrap();
        assert_eq!(format, CommonFormat { size: (32, 16), frames: Some(10) });
    }
    assert_eq!(clips.inputs(), ["scene:street", "scene:zero"]);
    for clip in [1, 0, 1] {
        assert_eq!(clips.open(clip).unwrap().count(), 5);
    }
}

/// A single clip stays open, so that it is not opened a second time.
#[test]
fn a_clip_that_is_open_is_played_once() {
    let source = CountedSource::new(4);
    let counts = source.counts.clone();
    let clips = RunClips::from_player(source.player(), &[]).unwrap();
    let format = clips.common_format(ClipReading::Once).unwrap();
    assert_eq!((format.frames, counts.read()), (Some(4), 0));
    assert_eq!(clips.open(0).unwrap().count(), 4);
    assert_eq!(counts.read(), 4);
}

#[test]
fn other_sizes_and_inputs_that_cannot_be_read_again_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.y4m");
    let frame = [b"FRAME\n".as_slice(), &[9; 256]].concat();
    let header = b"YUV4MPEG2 W16 H16 F25:1 Cmono\n".as_slice();
    fs::write(&path, [header, &frame].concat()).unwrap();
    let mixed = clips(&["scene:street", path.to_str().unwrap()], 2);
    let error = mixed.common_format(ClipReading::Repeated).unwrap_err().to_string();
    assert_eq!(
        error,
        "all clips of a run must have one size, but `street` has 32x16 pixels and `small` has 16x16; \
         give --resize, or --crop"
    );
    let streams = clips(&["scene:street", "-"], 2);
    let error = streams.common_format(ClipReading::Once).unwrap_err().to_string();
    assert!(
        error.starts_with("`-` can be read only once, so it must be the only input"),
        "{error}"
    );
    let stream = clips(&["-"], 2);
    let error = stream.common_format(ClipReading::Repeated).unwrap_err().to_string();
    assert!(error.contains("but this command reads its inputs several times"), "{error}");
}

#[test]
fn objects_are_found_by_the_numbers_of_frames() {
    let folder = tempfile::tempdir().unwrap();
    let boxes = folder.path().join("gt.txt");
    fs::write(&boxes, "2,1,3,4,8,8,1,1,1\n").unwrap();
    let inputs = [PathBuf::from("scene:street")];
    let options = InputOptions { frames: Some(3), ..InputOptions::default() };
    let clips = RunClips::new(&inputs, &[boxes], &camera(), &options).unwrap();
    assert!(clips.options().numbered && clips.boxes(0).is_some());
    let found = clips.open(0).unwrap().map(|frame| clips.objects(0, &frame.unwrap()).unwrap());
    let found: Vec<_> = found.map(|rects| rects.map(|rects| rects.len())).collect();
    assert_eq!(found, [None, Some(1), None]);
    assert!(clips.check_entries(0, true).is_ok() && clips.check_entries(0, false).is_err());
}

/// Returns the headers of a grey JPEG of 8x8 pixels, which is turned by its EXIF data.
fn turned_jpeg() -> Vec<u8> {
    // A directory of one entry, the orientation 6.
    let exif = b"Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
    let length = u16::try_from(exif.len() + 2).unwrap().to_be_bytes();
    let frame = b"\xFF\xC0\0\x0B\x08\0\x08\0\x08\x01\x01\x11\0";
    let scan = b"\xFF\xDA\0\x08\x01\x01\0\0\x3F\0";
    [b"\xFF\xD8\xFF\xE1", &length[..], exif, frame, scan].concat()
}

#[test]
fn boxes_that_may_be_wrong_are_told_of_before_the_frames_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    };
    let warnings = |boxes: &str, orientation| {
        let options = InputOptions { orientation, ..InputOptions::default() };
        let [clip, boxes] = ["clip", boxes].map(|name| folder.path().join(name));
        RunClips::new(&[clip], &[boxes], &camera(), &options)
            .map(|_| options.warnings.take())
            .map_err(|error| error.to_string())
    };
    write("clip/1.jpg", &turned_jpeg());
    write("clip/2.jpg", &turned_jpeg());
    write("yolo/1.txt", b"0 0.5 0.5 1 1\n");
    let said = warnings("yolo", Orientation::Stored).unwrap();
    let [turned] = &said[..] else { panic!("{said:?}") };
    assert!(turned.contains("2 of the first 2 images") && turned.contains("1.jpg"), "{turned}");
    assert!(warnings("yolo", Orientation::Upright).unwrap().is_empty());
    write("gt.txt", b"1,1,1,1,5,5,0,1,1\n2,1,1,1,5,5,1,1,1\n");
    let said = warnings("gt.txt", Orientation::Upright).unwrap();
    let [left_out] = &said[..] else { panic!("{said:?}") };
    assert!(left_out.contains("1 of 2 boxes") && left_out.contains("gt.txt"), "{left_out}");
    write("yolo/2.txt", b"0 0.5 0.5 1\n");
    let problem = warnings("yolo", Orientation::Upright).unwrap_err();
    assert!(problem.contains("2.txt") && problem.contains("line 1"), "{problem}");
}

/// Boxes are those of whole frames, also if the frames of an open clip are cropped.
#[test]
fn boxes_of_an_open_clip_are_cropped_with_its_frames() {
    let folder = tempfile::tempdir().unwrap();
    let boxes = folder.path().join("gt.txt");
    fs::write(&boxes, "1,1,9,5,4,4,1,1,1\n").unwrap();
    let crop = Some(CropRect { size: (16, 8), origin: (8, 4) });
    let options = InputOptions { frames: Some(1), crop, ..InputOptions::default() };
    let whole = ByteFrame::from_bytes(32, 16, 8, vec![0; 32 * 16]).unwrap();
    let player = source_from_memory("array", vec![whole], &options).unwrap();
    let clips = RunClips::from_player(player.into(), &[boxes]).unwrap();
    let mut player = clips.open(0).unwrap();
    let frame = player.next().unwrap().unwrap();
    let found = clips.objects(0, &frame).unwrap().unwrap();
    assert_eq!(found, [Rect::from_corners([0.0, 0.0, 4.0, 4.0]).unwrap()]);
}

#[test]
fn halves_are_counted_and_short_clips_refused() {
    let (hooks, two) = (RecordingHooks::new(), clips(&["scene:street", "scene:zero"], 7));
    let monitor = RunMonitor::of_frames(&hooks, None);
    let halves = ClipHalves::count(&two, 7, &monitor).unwrap();
    assert_eq!((halves.frames, hooks.reports().len()), (vec![(3, 7), (3, 7)], 14));
    let monitor = RunMonitor::of_frames(&SilentHooks, None);
    let short = ClipHalves::count(&two, 8, &monitor).unwrap_err().to_string();
    assert_eq!(short, "`street` has 7 frames; at least 8 are needed");
    let hooks = RecordingHooks::cancelling_after(9);
    let stopped = ClipHalves::count(&two, 1, &RunMonitor::of_frames(&hooks, None)).unwrap_err();
    assert!(matches!(stopped, PlaybackError::Interrupted), "{stopped}");
}
