// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of whole clips against the functional camera: scores, decisions and the rendered frame.
//! The designs are a matrix in which every value of every choice meets every other.

use foveate_camera::{Displacement, RegionAction};
use foveate_design::Design;
use foveate_model::{
    CoreInput, FunctionalCamera, FunctionalOutcome, RegionScorer, SerialRcm, ThresholdInputs,
    region_border, region_stream,
};
use foveate_pixels::Frame;

use super::bench::port_pixels;
use super::serial_parameters::SerialParameters;
use crate::hard_cases::hard_frames;
use crate::parameters::{DesignParameters, FeatureParameters, PeripheryParameters};
use crate::screen::ReceiverScreen;

/// Feeds a frame as fast as it is taken. Returns the number of clocks until the array is ready
/// again.
fn simulate(
    recipe: &SerialParameters,
    rcm: &mut SerialRcm,
    frame: &Frame,
    screen: &mut ReceiverScreen,
    outcome: &FunctionalOutcome,
) -> i64 {
    let thresholds = ThresholdInputs::from_camera(&screen.design);
    let mut pixels = port_pixels(recipe, frame).into_iter();
    let idle = vec![0; recipe.port_pixels() as usize];
    let (mut clocks, mut scores, mut decisions) = (0, 0, 0);
    // The last pixels may leave after the array is ready again.
    let mut behind = recipe.read_latency().max(1) - 1;
    loop {
        let now = if rcm.output().ready { pixels.next() } else { None };
        if clocks > 0 && rcm.output().ready && now.is_none() {
            if behind == 0 {
                break;
            }
            behind -= 1;
            clocks -= 1;
        }
        let valid = now.is_some();
        let pixels = now.unwrap_or_else(|| idle.clone());
        let output = rcm.step(&CoreInput { valid, ..CoreInput::idle(&pixels, &thresholds) });
        clocks += 1;
        let at = output.region as usize;
        if output.score_valid {
            scores += 1;
            let expected = match output.score_index.checked_sub(1) {
                None => outcome.temporal_count[at].into(),
                Some(feature) => outcome.scores[feature as usize][at],
            };
            let is_flow = |number: u32| recipe.base.features[number as usize].name == "flow";
            let is_flow = output.score_index.checked_sub(1).is_some_and(is_flow);
            let found = if is_flow { outcome.displacements[at] } else { Displacement::default() };
            let bits = |coordinate: i8| {
                let radius = recipe.base.features.iter().map(|feature| feature.radius).max();
                coordinate as u64 & if radius > Some(1) { 7 } else { 3 }
            };
            let shown = (output.displacement_x, output.displacement_y);
            assert_eq!(shown, (bits(found.dx), bits(found.dy)), "displacement of region {at}");
            assert_eq!(output.score, expected, "score {} of region {at}", output.score_index);
        }
        if output.decision_valid {
            decisions += 1;
            let summary = outcome.actions[at] == RegionAction::Summarize;
            let expected = (outcome.srs[at], outcome.trs[at], outcome.active[at], summary);
            let shown_bits = (output.srs, output.trs, output.active, output.summary);
            assert_eq!(shown_bits, expected, "decision of region {at}");
            screen.apply_decision(output.region, (output.srs, output.trs, output.summary));
        }
        for (port, (&valid, &pixel)) in
            output.forward_valid.iter().zip(&output.forward_pixel).enumerate()
        {
            if valid {
                let region = if recipe.raster {
                    output.forward_region
                } else {
                    port as u32 * recipe.fold as u32 + output.forward_slot
                };
                screen.show_value(region, output.forward_position, pixel);
            }
        }
    }
    let regions = recipe.regions();
    assert_eq!((decisions, scores), (regions, regions * (1 + recipe.base.features.len() as i64)));
    clocks
}

/// Checks that the scorer knows the results of a frame before the frame is fed.
fn check_prediction(rcm: &SerialRcm, frame: &Frame, outcome: &FunctionalOutcome, design: &Design) {
    let (thresholds, mut scorer) =
        (ThresholdInputs::from_camera(design), RegionScorer::new(design));
    for region in 0..design.regions() {
        let mut stream = Vec::new();
        region_stream(design, frame, region, &mut stream);
        scorer.load(stream.into_iter(), region_border(design, region));
        let reference = rcm.reference(region);
        let count = scorer.temporal_count(reference, &thresholds);
        assert_eq!(count, outcome.temporal_count[region as usize]);
        assert_eq!(scorer.means(), outcome.means[region as usize]);
        let scores = outcome.scores.iter().map(|scores| scores[region as usize]);
        assert!(
            scores.eq(scorer.scores(reference, &thresholds).into_iter().take(outcome.scores.len()))
        );
    }
}

fn check(recipe: &SerialParameters, clip: &[Frame]) {
    let design = recipe.design();
    let mut camera = FunctionalCamera::new(&design);
    let mut rcm = SerialRcm::new(design.as_serial().unwrap());
    let side = design.region_size();
    let width = design.columns() * side;
    let mut screen = ReceiverScreen::black(&design);
    for frame in clip {
        let outcome = camera.step(frame).unwrap();
        check_prediction(&rcm, frame, outcome, &screen.design);
        let clocks = simulate(recipe, &mut rcm, frame, &mut screen, outcome);
        let taking: i64 =
            (0..recipe.frame_pixels()).map(|pixel| recipe.clocks_of_pixel(pixel)).sum();
        assert_eq!(clocks, taking + recipe.steps_per_frame() + 1, "{recipe:?}");
        assert_eq!(clocks as u64, screen.design.timing().clocks_per_frame(), "{recipe:?}");
        let rendered = Frame::from_fn(frame.width(), frame.height(), frame.bits(), |x, y| {
            screen.pixels[(y * width + x) as usize]
        });
        assert_eq!(rendered.unwrap(), outcome.rendered, "{recipe:?}");
        let references = |region| rcm.reference(region).map(<[u16]>::to_vec);
        for region in 0..recipe.regions() as u32 {
            assert_eq!(references(region), camera.reference(region), "of region {region}");
            assert_eq!(rcm.summary(region), camera.summary(region), "summary of region {region}");
        }
    }
}

/// The filters that use a window.
const WINDOW_FILTERS: [&str; 3] = ["median3x3", "switching3x3", "binomial3x3"];

/// Returns some of the eight features. `which` has one bit for each.
fn features(which: usize, side: i64, bits: u32) -> Vec<FeatureParameters> {
    let max = (1i64 << bits) - 1;
    let feature = |name, level, min_milli| FeatureParameters {
        name,
        level,
        min_milli,
        fraction_bits: 1,
        radius: 1,
    };
    let all = [
        feature("variance", 0, 100 * max * max),
        feature("corner", max / 2, 1000),
        feature("mad", 0, 250 * max),
        feature("edge", 2 * max, 1000 * side),
        feature("range", 0, 600 * max),
        feature("surface", 0, 150 * max),
        feature("segment", max / 4, 1000 * (side / 2)),
        FeatureParameters { radius: 1 + side % 3, ..feature("flow", 0, 50 * max) },
    ];
    all.into_iter().enumerate().filter(|(at, _)| which >> at & 1 == 1).map(|(_, f)| f).collect()
}

#[test]
fn clips_over_the_matrix() {
    let mut number = 0usize;
    for side in [4i64, 5, 8, 16] {
        for bits in [1, 8, 12, 16] {
            for switches in 0..32usize {
                // The choices that are not in the loops change at their own rates.
                number += 1;
                let on = |bit: usize| switches >> bit & 1 == 1;
                let size = [(2 * side + 1, side + 2), (3 * side, side), (side, 1)][number % 3];
                let base = DesignParameters {
                    width: size.0,
                    height: size.1,
                    bits,
                    side,
                    shared: on(0),
                    filter: if on(1) { WINDOW_FILTERS[number / 7 % 3] } else { "none" },
                    features: features(1 + number % 255, side, bits),
                    all_must_vote: number.is_multiple_of(7),
                    temporal_level: ((1 << bits) - 1) / 2,
                    temporal_min: side,
                    last_sent: on(2),
                    blank_irrelevant: number % 5 < 3,
                    periphery: PeripheryParameters::from_number(number / 5, side, (1 << bits) - 1),
                    raw_payload: on(4),
                    constant: number.is_multiple_of(11),
                    deep: number % 4 < 2,
                    zones: None,
                    forced_srs: None,
                };
                let base = base.with_a_start();
                let frames = hard_frames(&base);
                let clip: Vec<Frame> =
                    (0..4).map(|at| frames[(number + at * at) % frames.len()].clone()).collect();
                let mut recipe = SerialParameters { base, raster: on(3), fold: 1 };
                recipe.fold = 1 + number as i64 % recipe.regions();
                check(&recipe, &clip);
            }
        }
    }
}

#[test]
fn every_fold_of_a_grid_of_seven() {
    for raster in [false, true] {
        for fold in 1..=7 {
            let base = DesignParameters {
                width: 28,
                height: 4,
                bits: 8,
                side: 4,
                shared: true,
                filter: "median3x3",
                features: features(255, 4, 8),
                all_must_vote: false,
                temporal_level: 3,
                temporal_min: 2,
                last_sent: true,
                blank_irrelevant: true,
                periphery: PeripheryParameters::from_number(fold as usize, 4, 255),
                raw_payload: false,
                constant: false,
                deep: false,
                zones: None,
                forced_srs: None,
            };
            let clip = hard_frames(&base);
            check(&SerialParameters { base, raster, fold }, &clip);
        }
    }
}

#[test]
fn the_largest_region() {
    for (raster, shared) in [(false, true), (true, true), (true, false)] {
        let base = DesignParameters {
            width: 65,
            height: 64,
            bits: 16,
            side: 64,
            shared,
            filter: if shared { "median3x3" } else { "none" },
            features: features(255, 64, 16),
            all_must_vote: false,
            temporal_level: 100,
            temporal_min: 9,
            last_sent: shared,
            blank_irrelevant: false,
            periphery: PeripheryParameters::from_number(if raster { 3 } else { 5 }, 64, 65_535),
            raw_payload: true,
            constant: false,
            deep: false,
            zones: None,
            forced_srs: None,
        };
        let clip = hard_frames(&base);
        check(&SerialParameters { base, raster, fold: 2 }, &clip[2..5]);
    }
}
