// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of hard frames at every clock. The designs are a matrix in which every value of every
//! choice meets every other.

use foveate_pixels::Frame;

use super::bench::{SerialBench, SerialStimulus, SerialTraffic};
use super::serial_parameters::SerialParameters;
use crate::hard_cases::{FILTERS, all_features, hard_frames, recipe_with_all_features};
use crate::parameters::{DesignParameters, PeripheryParameters};

/// Checks the array, and that the design knows how many clocks a frame takes.
fn check(recipe: &SerialParameters, clip: &[Frame]) {
    let taking: i64 = (0..recipe.frame_pixels()).map(|pixel| recipe.clocks_of_pixel(pixel)).sum();
    let clocks = (taking + recipe.steps_per_frame() + 1) as u64;
    assert_eq!(clocks, recipe.design().timing().clocks_per_frame(), "{recipe:?}");
    let traffic = SerialTraffic { skips: true, ..SerialTraffic::DENSE };
    let job = |frame| SerialStimulus::new(recipe, recipe.base.clone(), frame);
    let jobs: Vec<_> = clip.iter().map(job).collect();
    assert_eq!(SerialBench::new(recipe, traffic).run(&jobs), Ok(()), "{recipe:?}");
}

#[test]
fn hard_frames_over_the_matrix() {
    let mut number = 0usize;
    for side in [4i64, 5, 8, 16] {
        for bits in [1, 8, 12, 16] {
            for switches in 0..32usize {
                // The choices that are not in the loops change at their own rates.
                number += 1;
                let on = |bit: usize| switches >> bit & 1 == 1;
                let size = [(2 * side + 1, side + 2), (3 * side, side), (side, 1)][number % 3];
                let max = (1 << bits) - 1;
                let which = 1 + number % 255;
                let features = (0..).zip(all_features(side, bits));
                let base = DesignParameters {
                    filter: if on(1) { FILTERS[1 + number / 7 % 3] } else { "none" },
                    features: features
                        .filter(|(at, _)| which >> at & 1 == 1)
                        .map(|(_, f)| f)
                        .collect(),
                    all_must_vote: number.is_multiple_of(7),
                    temporal_min: side,
                    blank_irrelevant: number % 5 < 3,
                    periphery: PeripheryParameters::from_number(number / 5, side, max),
                    raw_payload: on(4),
                    constant: number.is_multiple_of(11),
                    deep: number % 4 < 2,
                    ..recipe_with_all_features(side, bits, size, (on(0), on(2)))
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
                temporal_level: 3,
                temporal_min: 2,
                periphery: PeripheryParameters::from_number(fold as usize, 4, 255),
                ..recipe_with_all_features(4, 8, (28, 4), (true, true))
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
            filter: if shared { "median3x3" } else { "none" },
            periphery: PeripheryParameters::from_number(if raster { 3 } else { 5 }, 64, 65_535),
            ..recipe_with_all_features(64, 16, (65, 64), (shared, shared))
        };
        let clip = hard_frames(&base);
        check(&SerialParameters { base, raster, fold: 2 }, &clip[2..5]);
    }
}
