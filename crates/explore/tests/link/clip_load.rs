// SPDX-License-Identifier: MIT OR Apache-2.0
//! The load of one design over a clip in a file, with the times that are worked out by hand for
//! cameras and cores.

use std::fs;
use std::path::{Path, PathBuf};

use foveate_camera::RegionAction;
use foveate_design::Design;
use foveate_explore::link::{
    ArrayLink, ClipLoad, LinkError, LinkFigures, SenderCameras, SentCounts, Timeline,
};
use foveate_media::{ImageRelation, InputOptions, RunClips, RunMonitor, SilentHooks};

use crate::raster::{MEGAHERTZ, NO_MEDIAN, VARIANCE, design, frame};

/// The regions of 4x4 pixels in the first row of regions.
const FIRST_ROW: [u32; 5] = [0, 1, 2, 3, 4];
/// The rate of a link that takes a word of 8 bits at every hundredth clock of 1 MHz.
const SLOW: u64 = 8 * MEGAHERTZ / 100;

/// Writes a clip of equal frames, one every 12 ms, with one row per millisecond.
fn clip_file(folder: &Path, design: &Design, patterned: &[u32], frames: usize) -> PathBuf {
    let one = [b"FRAME\n".to_vec(), frame(design, patterned)].concat();
    let file = [&b"YUV4MPEG2 W20 H12 F250:3 Ip A1:1 Cmono\n"[..], &one.repeat(frames)].concat();
    let path = folder.join("clip.y4m");
    fs::write(&path, file).unwrap();
    path
}

/// Measures a design over an input. The frames are opened with 8 bits.
fn measure(
    input: PathBuf,
    design: &Design,
    images: ImageRelation,
    (bits_per_second, clock_hz): (u64, Option<u64>),
) -> Result<ClipLoad, LinkError> {
    let options = InputOptions { images, ..InputOptions::default() };
    let camera = self::design(&[]).config().camera;
    let clips = RunClips::new(&[input], &[], &camera, &options)?;
    let monitor = RunMonitor::of_frames(&SilentHooks, None);
    ClipLoad::measure((&clips, 0), design, ArrayLink { bits_per_second, clock_hz }, &monitor)
}

/// Measures a design over a clip of two equal frames with these patterned regions.
fn load(design: &Design, patterned: &[u32], link: (u64, Option<u64>)) -> ClipLoad {
    let folder = tempfile::tempdir().unwrap();
    let clip = clip_file(folder.path(), design, patterned, 2);
    measure(clip, design, ImageRelation::Clip, link).unwrap()
}

/// The numbers are those of the tests of a raster core.
#[test]
fn a_clip_on_a_slow_link_needs_a_buffer_and_loses_regions_without_it() {
    let design = design(&[VARIANCE, NO_MEDIAN]);
    let slow = load(&design, &FIRST_ROW, (SLOW, Some(MEGAHERTZ)));
    // There are 240 words, and 9 clocks until the last decision, in 12 ms.
    assert_eq!((slow.needed_clock_hz, slow.frames, slow.duration_ns), (20_750, 2, 24_000_000));
    let array = slow.array.unwrap();
    assert_eq!(array.figures.decision_ns, (4_009 - 1_000) * 1000);
    assert_eq!(array.figures.delivery_ns.longest, (4_009 - 1_000) * 1000 + 650 * 12_500);
    assert_eq!((array.figures.buffer_bytes, array.figures.overloaded), (81, false));
    let unbuffered = array.unbuffered.unwrap();
    assert_eq!((unbuffered.lost_regions, &unbuffered.frames_with_losses[..]), (2, &[0][..]));
    assert_eq!(unbuffered.last_word_ns, (9_100 - 1_000) * 1000);
    let losses = "lost regions: 2, in 1 of 2 frames, first in frame 0";
    assert_eq!(unbuffered.losses_text(2), losses);
    // A hundred times the rate loses nothing.
    let fast = load(&design, &FIRST_ROW, (100 * SLOW, Some(MEGAHERTZ))).array.unwrap();
    assert_eq!(fast.unbuffered.unwrap().losses_text(2), "no region is lost");
}

/// A pixel of 10 bits takes the time of 10 bits, so that the same words are lost.
#[test]
fn frames_are_converted_to_the_depth_of_the_design() {
    let design = design(&[VARIANCE, NO_MEDIAN, "frame.pixel_bits=10"]);
    let link = (10 * MEGAHERTZ / 100, Some(MEGAHERTZ));
    let unbuffered = load(&self::design(&[VARIANCE, NO_MEDIAN]), &FIRST_ROW, link);
    assert_eq!(unbuffered.array.unwrap().unbuffered.unwrap().lost_regions, 1);
    let folder = tempfile::tempdir().unwrap();
    let clip = clip_file(folder.path(), &design, &FIRST_ROW, 2);
    let load = measure(clip, &design, ImageRelation::Clip, link).unwrap();
    assert_eq!(load.array.unwrap().unbuffered.unwrap().lost_regions, 2);
}

#[test]
fn a_clock_that_does_not_keep_up_has_no_figures() {
    let design = design(&[VARIANCE, NO_MEDIAN]);
    let at = |clock_hz| load(&design, &FIRST_ROW, (SLOW, Some(clock_hz)));
    let (slow, fast) = (at(20_749), at(20_750));
    assert_eq!((slow.needed_clock_hz, slow.clock_hz, slow.array), (20_750, Some(20_749), None));
    assert!(fast.array.is_some());
    // Without a clock its clocks are left out: these are those of 80 words behind a decision.
    assert_eq!(load(&design, &FIRST_ROW, (SLOW, None)).array.unwrap().added_clocks, 9 + 68);
}

/// A frame of 20x12 pixels has 3x2 regions of 8. The array takes a frame in 64 clocks, and needs no
/// clock that is fast enough for its rows one by one.
#[test]
fn the_clock_of_a_pipelined_array_is_that_of_whole_frames() {
    let set = ["hardware.organization=\"pipelined\"", "region.size=8", VARIANCE, NO_MEDIAN];
    let design = design(&set);
    let at = |clock_hz| load(&design, &[0, 5], (SLOW, clock_hz));
    // 64 clocks in 12 ms are 5,333.3 Hz.
    assert_eq!(at(None).needed_clock_hz, 5_334);
    assert_eq!(at(Some(5_333)).array, None);
    let timeline = Timeline::new("clip", &[0, 12_000], 12).unwrap();
    let cameras = SenderCameras::without_rows("clip", &design, &timeline, Some(5_334)).unwrap();
    let hold = RegionAction::Hold;
    let sent = [[RegionAction::Forward, hold, hold, hold, hold, RegionAction::Forward], [hold; 6]]
        .map(|actions| SentCounts::from_actions(&design, &actions, Vec::new()));
    let expected = cameras.slot_array(&sent);
    let array = at(Some(5_334)).array.unwrap();
    assert_eq!(array.added_clocks, expected.added_clocks);
    assert_eq!(array.figures, LinkFigures::from_units(expected.units, &timeline, SLOW));
    // 64 and 16 pixels of a frame come together with the decisions of the next one: 652 bits.
    assert_eq!((array.figures.buffer_bytes, array.unbuffered), (82, None));
}

#[test]
fn what_has_no_rate_or_sends_nothing_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let silent = design(&["hardware.forward=false"]);
    let design = design(&[]);
    let error = |input: &Path, design: &Design, images| {
        let found = measure(input.to_owned(), design, images, (SLOW, None));
        found.unwrap_err().to_string()
    };
    let clip = clip_file(folder.path(), &design, &[], 1);
    let found = error(&clip, &design, ImageRelation::Clip);
    assert!(found.contains("`clip` has 1 frame") && found.contains("at least 2"), "{found}");
    let found = error(&clip, &silent, ImageRelation::Clip);
    assert!(found.contains("hardware.forward = false"), "{found}");
    let images = folder.path().join("images");
    fs::create_dir(&images).unwrap();
    let image = [&b"P5 20 12 255\n"[..], &[7; 240]].concat();
    for name in ["a.pgm", "b.pgm"] {
        fs::write(images.join(name), &image).unwrap();
    }
    let found = error(&images, &design, ImageRelation::Set);
    assert!(found.contains("unrelated images") && found.contains("--images clip"), "{found}");
}
