// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scores that a person can check by hand.

use foveate_camera::{
    Camera, CameraConfig, Decimal, DenoiseFilter, FeatureKind, Neighborhood, ReferencePolicy,
    RegionAction, SpatialConfig,
};
use foveate_ideal::{IdealCamera, IdealError, IdealOutcome};
use foveate_pixels::ByteFrame;

/// Returns a configuration with all features, in the order of `FeatureKind::ALL`, and without
/// a filter. The minimum of `segment` is one that every region can have.
fn config(width: u32, height: u32, side: u32) -> CameraConfig {
    let mut config = CameraConfig::default();
    (config.frame.width, config.frame.height) = (Some(width), Some(height));
    config.region.size = side;
    config.denoise.filter = DenoiseFilter::None;
    config.spatial = FeatureKind::ALL.iter().map(|&kind| SpatialConfig::new(kind)).collect();
    config.spatial[6].min_score = Some(Decimal::from_whole(1));
    config
}

fn frame(camera: &Camera, pixel: impl Fn(u32, u32) -> u8) -> ByteFrame {
    let (width, height) = (camera.width(), camera.height());
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixels = pixels.map(|(x, y)| pixel(x, y)).collect();
    ByteFrame::from_bytes(width, height, 8, pixels).unwrap()
}

fn outcome_of_first_frame(config: &CameraConfig, pixel: impl Fn(u32, u32) -> u8) -> IdealOutcome {
    let camera = config.validate().unwrap();
    IdealCamera::new(&camera).step(&frame(&camera, pixel)).unwrap().clone()
}

#[test]
fn a_constant_frame_scores_nothing() {
    let outcome = outcome_of_first_frame(&config(20, 13, 8), |_, _| 77);
    assert_eq!(outcome.scores, vec![vec![0.0; 6]; 8]);
    assert_eq!(outcome.changed, vec![64.0; 6], "no reference: all pixels");
    assert_eq!((outcome.srs, outcome.trs), (vec![false; 6], vec![true; 6]));
    assert_eq!((outcome.denoised, outcome.rendered), (vec![77.0; 260], vec![0.0; 260]));
}

/// The left half is 0 and the right half 30, so |Gx| = 4 * 30 > 100 at the two columns next to the
/// step.
#[test]
fn a_step_is_an_edge_two_pixels_wide() {
    let outcome = outcome_of_first_frame(&config(16, 8, 8), |x, _| if x < 8 { 0 } else { 30 });
    assert_eq!(outcome.scores[0], [8.0, 8.0], "one column in each region, across their border");
    assert_eq!(outcome.scores[1], [0.0, 0.0], "three neighbors are no arc");
    for scores in &outcome.scores[2..] {
        assert_eq!(scores[..], [0.0, 0.0], "each region has one value");
    }
    // The step lies inside one region: half of the pixels are 15 above the mean, half 15 below.
    let outcome = outcome_of_first_frame(&config(8, 8, 8), |x, _| if x < 4 { 0 } else { 30 });
    let scores: Vec<f64> = outcome.scores.iter().map(|scores| scores[0]).collect();
    // A column is equal to itself below, and all pixels are more than 8 away from the mean.
    assert_eq!(scores, [16.0, 0.0, 15.0, 225.0, 30.0, 0.0, 32.0, 0.0]);
}

/// A ramp moves to the right by one pixel, and 16 of its 20 pixels are off by one. So the mean
/// difference is 70 / 25 in place and 16 / 20 at the displacement, and their difference is 2, the
/// minimum. The difference of the rounded quotients is smaller.
#[test]
fn a_displacement_that_is_better_by_exactly_the_minimum_votes() {
    // The sums of the rows are 3, 3, 4, 3, 3, so no other displacement is better.
    const ERRORS: [[i8; 5]; 5] = [
        [0, 1, -1, -1, 0],
        [0, 1, -1, -1, 0],
        [0, -1, -1, -1, -1],
        [0, 1, -1, -1, 0],
        [0, -1, -1, -1, 0],
    ];
    let mut config = config(5, 5, 5);
    config.spatial = vec![SpatialConfig::new(FeatureKind::Flow)];
    let camera = config.validate().unwrap();
    let mut ideal = IdealCamera::new(&camera);
    let ramp = |x: u32| u8::try_from(50 + 3 * x).unwrap();
    ideal.step(&frame(&camera, |x, _| ramp(x))).unwrap();
    let moved = frame(&camera, |x, y| {
        ramp(x.saturating_sub(1)).saturating_add_signed(ERRORS[y as usize][x as usize])
    });
    let outcome = ideal.step(&moved).unwrap();
    assert_eq!((&outcome.scores[0][..], &outcome.srs[..]), (&[2.0][..], &[true][..]));
}

/// The ideal camera ignores the neighborhood and the fraction bits of the configuration.
#[test]
fn properties_of_hardware_have_no_effect() {
    let mut isolated = config(24, 16, 8);
    isolated.region.neighborhood = Neighborhood::Isolated;
    let mut shared = isolated.clone();
    shared.region.neighborhood = Neighborhood::Shared;
    shared.spatial[2].mean_fraction_bits = Some(6);
    shared.spatial[6].mean_fraction_bits = Some(6);
    let pixel = |x: u32, y: u32| u8::try_from((x * 37 + y * 101 + x * y * 7) % 256).unwrap();
    assert_eq!(outcome_of_first_frame(&isolated, pixel), outcome_of_first_frame(&shared, pixel));
}

/// The checkerboard of 0 and 200 has mean 100; every pixel is 100 away from it, the variance is
/// 10,000, and the range is 200. Moved to the right or down, it differs everywhere but in the last
/// column or row, which meets itself. Moved along a diagonal, it differs only there.
#[test]
fn a_checkerboard_has_the_scores_of_its_amplitude() {
    let pixel = |x: u32, y: u32| if (x + y).is_multiple_of(2) { 0 } else { 200 };
    let outcome = outcome_of_first_frame(&config(8, 8, 8), pixel);
    assert_eq!([2, 3, 4].map(|place| outcome.scores[place][0]), [100.0, 10_000.0, 200.0]);
    assert_eq!(outcome.scores[5][0], 14.0 * 200.0 / 64.0, "7 pixels of two sides");
    assert_eq!(outcome.scores[6][0], 32.0);
    // Inside the region Gx and Gy are 0. At the border the window repeats a line, so |G| is 0 along
    // a side, too.
    assert_eq!(outcome.scores[1][0], 0.0, "neighbors alternate");
    // Five of these 3x3 pixels are 0: the mean is 800/9, which is not a binary fraction.
    let outcome = outcome_of_first_frame(&config(3, 3, 3), pixel);
    let (mean, n) = (800.0 / 9.0, 9.0);
    let mad = (5.0 * mean + 4.0 * (200.0 - mean)) / n;
    let variance = 4.0 * 200.0 * 200.0 / n - mean * mean;
    assert!((outcome.scores[2][0] - mad).abs() < 1e-12);
    assert!((outcome.scores[3][0] - variance).abs() < 1e-10);
}

#[test]
fn a_bright_pixel_is_a_corner_only_at_its_own_place() {
    let mut config = config(9, 9, 9);
    let outcome = outcome_of_first_frame(&config, |x, y| if (x, y) == (4, 4) { 250 } else { 0 });
    assert_eq!(outcome.scores[1][0], 1.0);
    assert_eq!(outcome.scores[0][0], 8.0, "the eight around it, |G| = 500; its own is 0");
    config.denoise.filter = DenoiseFilter::Median3x3;
    let outcome = outcome_of_first_frame(&config, |x, y| if (x, y) == (4, 4) { 250 } else { 0 });
    assert_eq!((outcome.scores[1][0], outcome.denoised), (0.0, vec![0.0; 81]));
}

/// Two levels around the mean 8.5 of four pixels: 6 and 11 are 2.5 away from it.
#[test]
fn a_segment_is_farther_from_the_real_mean_than_the_level() {
    let segment = |level: u32| {
        let mut config = config(2, 2, 2);
        config.spatial = vec![SpatialConfig::new(FeatureKind::Segment)];
        config.temporal.min_count = 1;
        (config.spatial[0].level, config.spatial[0].min_score) =
            (Some(level), Some(Decimal::from_whole(1)));
        let pixel = |x: u32, y: u32| [[6, 11], [8, 9]][y as usize][x as usize];
        outcome_of_first_frame(&config, pixel).scores[0][0]
    };
    assert_eq!([0, 1, 2, 3].map(segment), [2.0, 1.0, 1.0, 0.0]);
}

/// The differences of a frame to the pixels at the four displacements; the window repeats the last
/// column and row.
#[test]
fn a_surface_is_the_smallest_of_four_mean_differences() {
    let mut config = config(2, 2, 2);
    config.spatial = vec![SpatialConfig::new(FeatureKind::Surface)];
    config.temporal.min_count = 1;
    let pixel = |x: u32, y: u32| [[10, 20], [14, 50]][y as usize][x as usize];
    // Right: 10 + 36. Below: 4 + 30. Below to the right: 40 + 30 + 36. Below to the left: 4 + 6 +
    // 0 + 36.
    assert_eq!(outcome_of_first_frame(&config, pixel).scores, [[34.0 / 4.0]]);
}

/// The filters around a single pixel of 160 and at the border of a step of 1.
#[test]
fn the_binomial_filter_is_not_rounded_and_the_switching_median_removes_single_pixels() {
    let filtered = |filter: DenoiseFilter, pixel: &dyn Fn(u32, u32) -> u8| {
        let mut config = config(3, 3, 3);
        config.denoise.filter = filter;
        outcome_of_first_frame(&config, pixel).denoised
    };
    let spot = |x: u32, y: u32| if (x, y) == (1, 1) { 160 } else { 0 };
    let means = [10.0, 20.0, 10.0, 20.0, 40.0, 20.0, 10.0, 20.0, 10.0];
    assert_eq!(filtered(DenoiseFilter::Binomial3x3, &spot), means);
    assert_eq!(filtered(DenoiseFilter::Switching3x3, &spot), [0.0; 9]);
    let step = |x: u32, _: u32| u8::from(x > 0);
    let row = [0.25, 0.75, 1.0];
    assert_eq!(filtered(DenoiseFilter::Binomial3x3, &step), [row, row, row].concat());
    // Every pixel is the largest or the smallest of its window, and the median keeps the step.
    let row = [0.0, 1.0, 1.0];
    assert_eq!(filtered(DenoiseFilter::Switching3x3, &step), [row, row, row].concat());
    let ramp = |x: u32, y: u32| u8::try_from(10 * x + y).unwrap();
    assert_eq!(filtered(DenoiseFilter::Switching3x3, &ramp)[4], 11.0, "a value in between stays");
}

/// A decimal minimum is compared exactly: the first equals the score, the second is just above it.
#[test]
fn thresholds_are_those_of_the_configuration() {
    for (minimum, srs) in [(1.5, true), (1.6, false)] {
        let mut config = config(4, 2, 2);
        config.spatial = vec![SpatialConfig::new(FeatureKind::Mad)];
        config.spatial[0].min_score = Decimal::from_f64(minimum);
        config.temporal.min_count = 1;
        let outcome =
            outcome_of_first_frame(&config, |x, _| if x < 2 { 9 } else { 3 * u8::from(x == 2) });
        assert_eq!(outcome.scores, [[0.0, 1.5]]);
        assert_eq!(outcome.srs, [false, srs]);
    }
}

#[test]
fn a_fade_is_sent_once_it_has_gone_far_enough() {
    let mut config = config(8, 8, 8);
    config.spatial = vec![SpatialConfig::new(FeatureKind::Mad)];
    config.spatial[0].min_score = Some(Decimal::from_whole(0));
    config.temporal.reference = ReferencePolicy::LastSent;
    config.temporal.level = Some(2);
    let camera = config.validate().unwrap();
    let mut ideal = IdealCamera::new(&camera);
    let mut sent = Vec::new();
    for level in 0..7 {
        let outcome = ideal.step(&frame(&camera, |_, _| 10 + level)).unwrap();
        sent.push(outcome.actions[0] == RegionAction::Forward);
        assert!((outcome.rendered[0] - f64::from(10 + level)).abs() <= 2.0);
    }
    assert_eq!(sent, [true, false, false, true, false, false, true]);
}

#[test]
fn other_frames_are_refused_and_change_nothing() {
    let camera = config(8, 8, 8).validate().unwrap();
    let mut ideal = IdealCamera::new(&camera);
    let before = ideal.step(&frame(&camera, |_, _| 9)).unwrap().clone();
    let other = ByteFrame::from_bytes(8, 7, 8, vec![0; 56]).unwrap();
    let error = ideal.step(&other).unwrap_err();
    let [given, expected] = ["8x7 pixels of 8 bits", "8x8 pixels of 8 bits"].map(str::to_owned);
    assert_eq!(error, IdealError::FrameFormat { given, expected });
    assert_eq!(ideal.outcome(), &before);
}

/// A line of 64 moves one column to the right: two of eight columns differ by 64, and none of the
/// seven pairs of the displacement.
#[test]
fn flow_is_the_gain_of_the_best_displacement() {
    let mut config = config(8, 8, 8);
    config.spatial = vec![SpatialConfig::new(FeatureKind::Flow)];
    let camera = config.validate().unwrap();
    let mut ideal = IdealCamera::new(&camera);
    let line = |column: u32| frame(&camera, move |x, _| if x == column { 64 } else { 0 });
    let mut score = |column| ideal.step(&line(column)).unwrap().scores[0][0];
    // The search reaches one column, so it does not find the step of two.
    assert_eq!([3, 4, 4, 2].map(&mut score), [0.0, 16.0, 0.0, 0.0]);
}
