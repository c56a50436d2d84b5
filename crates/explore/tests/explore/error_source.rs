// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sources of a design's flips, against runs of cameras that are written out here, and against
//! clips that can be counted by hand.

use std::fs;
use std::path::{Path, PathBuf};

use foveate_camera::CameraConfig;
use foveate_explore::{DisturbedDesign, ErrorSourceRow, compare, disturb_design};
use foveate_media::{ClipPlayer, InputOptions, testing::RecordingHooks};

const NAMES: [&str; 7] =
    ["windows", "filter", "bits", "thresholds", "fraction bits", "reference", "interaction"];

fn config(text: &str) -> CameraConfig {
    CameraConfig::from_toml(text).unwrap()
}

fn disturbed(design: &str, task: &str, input: &str, frames: u32) -> DisturbedDesign {
    let options = InputOptions { frames: Some(frames), ..InputOptions::default() };
    let cameras = (&config(design), &config(task));
    let found =
        disturb_design(cameras, &[PathBuf::from(input)], &options, &RecordingHooks::new()).unwrap();
    let names: Vec<&str> = found.sources.iter().map(|row| row.source).collect();
    assert_eq!(names, NAMES);
    let sum: f64 = found.sources.iter().filter_map(|row| row.flips).sum();
    assert!((sum - found.rows[0].flips).abs() < 1e-12, "{sum} {:?}", found.rows[0]);
    found
}

fn row<'a>(found: &'a DisturbedDesign, source: &str) -> &'a ErrorSourceRow {
    found.sources.iter().find(|row| row.source == source).unwrap()
}

const FRAMES: u32 = 16;
const TASK: &str = "frame = { width = 96, height = 64 }\nspatial = [{ feature = 'edge' }, { feature = 'mad' }]\n\
     temporal.reference = 'last-sent'\n";
/// The values of the design in place of the task's bits, windows, filter, level and minimum of
/// `edge`, minimum and fraction bits of `mad`, level, count and reference.
const DESIGN: [&str; 10] = ["5", "isolated", "none", "11", "6", "0.7", "0", "2", "4", "'previous'"];

fn design_with(changes: &[(usize, &str)]) -> String {
    let mut values = DESIGN;
    changes.iter().for_each(|&(at, value)| values[at] = value);
    let [bits, windows, filter, edge, hits, mad, fraction, level, count, reference] = values;
    format!(
        "frame = {{ width = 96, height = 64, pixel_bits = {bits} }}\nregion.neighborhood = '{windows}'\n\
         denoise.filter = '{filter}'\ntemporal = {{ level = {level}, min_count = {count}, reference = {reference} }}\n\
         spatial = [{{ feature = 'edge', level = {edge}, min_score = {hits} }}, \
         {{ feature = 'mad', min_score = {mad}, mean_fraction_bits = {fraction} }}]\n"
    )
}

/// Returns the number of flipped regions of a camera in the first frames of street, times a
/// constant.
fn flips(design: &str, frames: u32) -> f64 {
    let options = InputOptions { frames: Some(frames), ..InputOptions::default() };
    let task = config(TASK);
    let player = ClipPlayer::open(&["scene:street"], &task, &options).unwrap();
    let found = compare(player, &config(design), &task, &RecordingHooks::new()).unwrap();
    assert_eq!(found.figures.frames, u64::from(frames));
    found.figures.action_flips * f64::from(frames)
}

#[test]
fn every_row_is_a_camera_with_one_thing_of_the_task() {
    let found = disturbed(&design_with(&[]), TASK, "scene:street", FRAMES);
    let variants: [&[(usize, &str)]; 6] = [
        &[(1, "shared")],
        &[(2, "median3x3")],
        &[(0, "8"), (3, "88"), (5, "5.6"), (7, "16")],
        // More than 100 / 8 = 12.5 is more than 12; 5 / 8 is 0.625.
        &[(3, "12"), (4, "5"), (5, "0.625"), (7, "1"), (8, "5")],
        &[(6, "6")],
        &[(9, "'last-sent'")],
    ];
    let own = flips(&design_with(&[]), FRAMES);
    for (variant, row) in variants.iter().zip(&found.sources) {
        let expected = (own - flips(&design_with(variant), FRAMES)) / f64::from(FRAMES);
        let share = row.flips.unwrap();
        assert!((share - expected).abs() < 1e-12 && share != 0.0, "{row:?} {expected}");
        assert_eq!(row.reason, None);
    }
    // Eight groups of two frames, with Student's t of 7 degrees of freedom.
    let until = |frames| {
        let filtered = flips(&design_with(variants[1]), frames);
        flips(&design_with(&[]), frames) - filtered
    };
    let sums: Vec<f64> =
        (0..=8).map(|group| if group == 0 { 0.0 } else { until(2 * group) }).collect();
    let without: Vec<f64> =
        sums.windows(2).map(|two| (sums[8] - (two[1] - two[0])) / 14.0).collect();
    let mean = without.iter().sum::<f64>() / 8.0;
    let squares: f64 = without.iter().map(|share| (share - mean).powi(2)).sum();
    let margin = 1.895 * (2.0 * 7.0 / 8.0 * squares).sqrt();
    let row = row(&found, "filter");
    let [least, most] = row.interval.unwrap();
    let share = row.flips.unwrap();
    assert!((share - margin - least).abs() < 1e-12, "{row:?} {margin}");
    assert!((share + margin - most).abs() < 1e-12 && margin > 0.0, "{row:?} {margin}");
}

#[test]
fn a_design_that_is_the_task_has_no_sources() {
    let task = "frame = { width = 96, height = 64 }\nregion.neighborhood = 'shared'\n";
    let found = disturbed(task, task, "scene:street", 8);
    for row in found.sources {
        assert_eq!((row.flips, row.interval, row.reason), (Some(0.0), Some([0.0; 2]), None));
    }
}

/// Writes two frames of two regions of 8x8 pixels; `pixel` gives those at a column and row of a
/// region.
fn write_frames(folder: &Path, pixel: impl Fn([usize; 2], (usize, usize)) -> u8) {
    fs::create_dir(folder).unwrap();
    for number in 0..2 {
        let places = (0..8).flat_map(|y| (0..16).map(move |x| (x, y)));
        let pixels = places.map(|(x, y)| pixel([number, x / 8], (x % 8, y)));
        let file = [b"P5\n16 8\n255\n".to_vec(), pixels.collect()].concat();
        fs::write(folder.join(format!("{number}.pgm")), file).unwrap();
    }
}

/// At 5 bits the thresholds of the task are 1.5 and 2.5. The left region changes by 2, which is
/// more than 1.5, and the right one has a range of 2, which is less than 2.5. So with them the
/// decisions are those of the ideal, and the nearest whole numbers, 2 and 2, as well as 1 and 2 or
/// 2 and 3, would make others.
#[test]
fn thresholds_are_not_rounded() {
    let dir = tempfile::tempdir().unwrap();
    let clip = dir.path().join("clip");
    let values = [[[64, 128], [96, 112]], [[80, 144], [96, 112]]];
    write_frames(&clip, |[number, region], (x, y)| values[number][region][(x + y) % 2]);
    let camera = |bits: u32, level: u32, feature: &str| {
        format!(
            "frame.pixel_bits = {bits}\nregion.neighborhood = 'shared'\ndenoise.filter = 'none'\n\
             temporal.level = {level}\nspatial = [{{ feature = {feature} }}]\n"
        )
    };
    let [own, task] = [(5, 3, "'range', min_score = 2"), (8, 12, "'range', min_score = 20")]
        .map(|(bits, level, feature)| camera(bits, level, feature));
    let found = disturbed(&own, &task, clip.to_str().unwrap(), 2);
    // The left region misses the change in the second frame, and the right one is relevant in both.
    assert_eq!(found.rows[0].flips, 0.75);
    let shares = |found: &DisturbedDesign| -> Vec<f64> {
        found.sources.iter().map(|row| row.flips.unwrap()).collect()
    };
    assert_eq!(shares(&found), [0.0, 0.0, 0.0, 0.75, 0.0, 0.0, 0.0]);
    // With two groups, 1 and 0.5 without one of them, t is 6.314, so the interval is wider than all
    // shares.
    assert_eq!(row(&found, "thresholds").interval, Some([-1.0, 1.0]));

    // Around a bright pixel there are eight gradients of 14 at 5 bits, which is more than 108 / 8 =
    // 13.5 and not more than the nearest whole level, 14.
    let dots = dir.path().join("dots");
    write_frames(&dots, |_, place| if place == (4, 4) { 120 } else { 64 });
    let [own, task] = [(5, "'edge', level = 14"), (8, "'edge', level = 108")]
        .map(|(bits, feature)| camera(bits, bits, feature));
    let found = disturbed(&own, &task, dots.to_str().unwrap(), 2);
    assert_eq!(shares(&found), [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    assert_eq!(row(&found, "thresholds").interval, Some([1.0, 1.0]));
}

#[test]
fn rows_without_a_figure_say_why() {
    let camera = |spatial: &str, bits: u32, size: u32| {
        format!(
            "frame = {{ width = 48, height = 32, pixel_bits = {bits} }}\nregion.size = {size}\n\
             spatial = [{{ feature = {spatial} }}]\n"
        )
    };
    for (own, size, given, part) in [
        ("'edge'", 16, "'edge'", Some("regions of 8x8 pixels; use a task with region.size = 16")),
        ("'mad'", 8, "'edge'", Some("no thresholds for `mad`")),
        ("'segment', mean_fraction_bits = 1", 8, "'segment'", Some("a multiple of 16")),
        ("'segment', mean_fraction_bits = 0", 8, "'segment'", None),
        ("'segment', mean_fraction_bits = 1", 8, "'segment', level = 16", None),
    ] {
        let found = disturbed(&camera(own, 4, size), &camera(given, 8, 8), "scene:street", 3);
        let ErrorSourceRow { flips, interval, reason, .. } = row(&found, "thresholds");
        let reason = reason.as_deref();
        assert_eq!(
            (flips.is_none(), interval.is_none()),
            (part.is_some(), part.is_some()),
            "{own}"
        );
        assert_eq!(
            reason.is_some_and(|text| text.contains(part.unwrap_or("-"))),
            part.is_some(),
            "{reason:?}"
        );
    }
    // A camera with `flow` alone and this reference would never send anything.
    let task = camera("'edge'", 8, 8) + "temporal.reference = 'last-sent'\n";
    let found = disturbed(&camera("'flow'", 8, 8), &task, "scene:street", 1);
    let refused = row(&found, "reference").reason.as_deref().unwrap();
    assert!(refused.contains("last-sent"), "{refused}");
    let ErrorSourceRow { flips, interval, reason, .. } = row(&found, "filter");
    assert_eq!((*flips, *interval), (Some(0.0), None));
    assert!(reason.as_deref().unwrap().contains("2 frames"));
}
