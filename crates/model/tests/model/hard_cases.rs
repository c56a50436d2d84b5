// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of cases at the ends of ranges, with explicit expected numbers.

use foveate_design::{Design, DesignConfig};
use foveate_model::{FunctionalCamera, ModelError, PipelinedRcm, region_border, region_stream};
use foveate_pixels::Frame;

use crate::parameters::{DesignParameters, FeatureParameters, PeripheryParameters};
use crate::{functional_properties, pipelined_properties};

fn design(toml: &str) -> Design {
    DesignConfig::from_toml(toml).unwrap().validate().unwrap()
}

fn score(toml: &str, frame: &Frame) -> u64 {
    let size = format!(
        "[frame]\nwidth = {}\nheight = {}\npixel_bits = {}\n[denoise]\nfilter = \"none\"\n",
        frame.width(),
        frame.height(),
        frame.bits()
    );
    FunctionalCamera::new(&design(&format!("{size}{toml}"))).step(frame).unwrap().scores[0][0]
}

#[test]
fn hits_of_ramps_and_peaks_on_below_and_above_the_level() {
    // The slope is 3. |Gx| is 8 * 3 inside of an isolated region and 4 * 3 in its border columns.
    let ramp = Frame::from_fn(8, 8, 8, |x, _| 3 * x as u16).unwrap();
    let edges =
        |level: u32| score(&format!("[[spatial]]\nfeature = \"edge\"\nlevel = {level}"), &ramp);
    assert_eq!([11, 12, 23, 24, 25].map(edges), [64, 48, 48, 0, 0]);
    // All neighbors of a peak of 9 above flat ground are darker by 9, so the peak is one corner for
    // each level below 9.
    let peak = Frame::from_fn(8, 8, 8, |x, y| 50 + 9 * u16::from((x, y) == (4, 4))).unwrap();
    let corners =
        |level: u32| score(&format!("[[spatial]]\nfeature = \"corner\"\nlevel = {level}"), &peak);
    assert_eq!([0, 8, 9, 10].map(corners), [1, 1, 0, 0]);
}

#[test]
fn streams_and_borders_of_a_ragged_shared_frame() {
    let shared = design(
        "[frame]\nwidth = 3\nheight = 2\n[region]\nsize = 2\nneighborhood = \"shared\"\n\
         [denoise]\nfilter = \"none\"\n[temporal]\nmin_count = 0\n[[spatial]]\nfeature = \"edge\"\nmin_score = 0",
    );
    let frame = Frame::new(3, 2, 8, vec![1, 2, 3, 4, 5, 6]).unwrap();
    let stream = |region| {
        let mut out = Vec::new();
        region_stream(&shared, &frame, region, &mut out);
        out
    };
    assert_eq!(stream(0), [1, 1, 2, 3, 1, 1, 2, 3, 4, 4, 5, 6, 4, 4, 5, 6]);
    assert_eq!(stream(1), [2, 3, 3, 3, 2, 3, 3, 3, 5, 6, 6, 6, 5, 6, 6, 6]);
    assert_eq!([0, 1].map(|region| region_border(&shared, region)), [0b1101, 0b1110]);
    let grid = design("[frame]\nwidth = 24\nheight = 24");
    assert_eq!(region_border(&grid, 4), 0);
    assert_eq!([0, 2, 6, 8].map(|r| region_border(&grid, r)), [0b0101, 0b0110, 0b1001, 0b1010]);
}

#[test]
fn a_frame_of_another_kind_is_refused_and_changes_nothing() {
    let mut camera = FunctionalCamera::new(&design("[frame]\nwidth = 8\nheight = 8"));
    let error = camera.step(&Frame::filled(8, 9, 8, 0).unwrap()).unwrap_err();
    assert!(matches!(error, ModelError::FrameKind { .. }));
    assert_eq!(
        error.to_string(),
        "the frame has 8x9 pixels of 8 bits, but the design takes 8x8 pixels of 8 bits; \
         give it frames of that kind"
    );
    assert!(camera.step(&Frame::filled(8, 8, 9, 0).unwrap()).is_err());
    assert!(camera.step(&Frame::filled(8, 8, 8, 0).unwrap()).unwrap().trs[0], "still the first");
}

/// Returns frames that are black, white, checkerboards, single pixels in each corner of a region,
/// and a ramp.
pub(crate) fn hard_frames(recipe: &DesignParameters) -> Vec<Frame> {
    let (width, height) = (recipe.width as u32, recipe.height as u32);
    let (max, side) = (recipe.pixel_max() as u16, recipe.side as u32);
    let frame_from =
        |f: &dyn Fn(u32, u32) -> u16| Frame::from_fn(width, height, recipe.bits, f).unwrap();
    let at_corner =
        |x: u32, y: u32| [0, side - 1].contains(&(x % side)) && [0, side - 1].contains(&(y % side));
    vec![
        frame_from(&|_, _| 0),
        frame_from(&|_, _| max),
        frame_from(&|x, y| if (x + y) % 2 == 0 { max } else { 0 }),
        frame_from(&|x, y| if (x + y) % 2 == 1 { max } else { 0 }),
        frame_from(&|x, y| if at_corner(x, y) { max } else { 0 }),
        frame_from(&|x, y| if at_corner(x, y) { 0 } else { max }),
        frame_from(&|x, y| ((x + 2 * y) % (u32::from(max) + 1)) as u16),
    ]
}

pub(crate) const FILTERS: [&str; 4] = ["none", "median3x3", "switching3x3", "binomial3x3"];

pub(crate) fn feature(name: &'static str, level: i64, min_milli: i64) -> FeatureParameters {
    FeatureParameters { name, level, min_milli, fraction_bits: 1, radius: 1 }
}

/// Returns all features for regions of this side, `flow` last.
pub(crate) fn all_features(side: i64, bits: u32) -> Vec<FeatureParameters> {
    let max = (1i64 << bits) - 1;
    vec![
        feature("variance", 0, 100 * max * max),
        feature("corner", max / 2, 1000),
        feature("mad", 0, 250 * max),
        feature("edge", 2 * max, 1000 * side),
        feature("range", 0, 600 * max),
        feature("surface", 0, 150 * max),
        feature("segment", max / 4, 1000 * (side / 2)),
        FeatureParameters { radius: (1 + side % 3).min(side - 1), ..feature("flow", 0, 50 * max) },
    ]
}

pub(crate) fn recipe_with_all_features(
    side: i64,
    bits: u32,
    (width, height): (i64, i64),
    (shared, last_sent): (bool, bool),
) -> DesignParameters {
    let max = (1i64 << bits) - 1;
    DesignParameters {
        width,
        height,
        bits,
        side,
        shared,
        filter: FILTERS[(side + i64::from(bits)) as usize % 4],
        features: all_features(side, bits),
        all_must_vote: false,
        temporal_level: max / 2,
        temporal_min: side * side / 2,
        last_sent,
        blank_irrelevant: bits.is_multiple_of(4),
        periphery: PeripheryParameters::from_number((side + width) as usize, side, max),
        raw_payload: side % 2 == 1,
        constant: false,
        deep: false,
        zones: None,
        forced_srs: None,
    }
}

/// Checks the pipelined organization, which has all features except `flow`.
fn check_pipelined(recipe: &DesignParameters, frames: &[Frame]) {
    let mut recipe = recipe.clone();
    recipe.features.pop();
    let mut rcm = PipelinedRcm::new(recipe.design().as_pipelined().unwrap());
    pipelined_properties::check_dense(&recipe, &mut rcm, frames);
}

#[test]
fn hard_frames_at_the_ends_of_every_range() {
    for side in [2, 3, 5, 7] {
        for bits in [1, 10, 12, 16] {
            for kind in [(false, true), (true, false), (true, true)] {
                for size in [(1, 1), (side, side + 1), (2 * side, side - 1)] {
                    let recipe = recipe_with_all_features(side, bits, size, kind);
                    let frames = hard_frames(&recipe);
                    functional_properties::check(&recipe, &frames);
                    check_pipelined(&recipe, &frames);
                }
            }
        }
    }
}

#[test]
fn the_largest_region() {
    for shared in [false, true] {
        let recipe = recipe_with_all_features(64, 16, (65, 40), (shared, shared));
        functional_properties::check(&recipe, &hard_frames(&recipe)[1..]);
        let recipe = recipe_with_all_features(64, 16, (64, 64), (shared, shared));
        check_pipelined(&recipe, &hard_frames(&recipe)[2..5]);
    }
}
