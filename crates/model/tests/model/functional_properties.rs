// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the functional model equals the oracle, for every kind of design.

use foveate_camera::Camera;
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_pixels::Frame;
use proptest::prelude::*;

use crate::frames::{arbitrary_scripts, make_clip};
use crate::oracle::{OracleFrame, OracleOutcome, oracle_history};
use crate::parameters::{DesignParameters, PeripheryParameters, arbitrary_cameras};

fn frame_values(frame: &Frame) -> OracleFrame {
    let row = |y| frame.row(y).iter().map(|&pixel| i64::from(pixel)).collect();
    (0..frame.height()).map(row).collect()
}

pub(crate) fn assert_outcome_is(
    recipe: &DesignParameters,
    outcome: &FunctionalOutcome,
    expected: &OracleOutcome,
) {
    assert_eq!(frame_values(&outcome.padded), expected.padded);
    assert_eq!(frame_values(&outcome.denoised), expected.denoised);
    let displaced = if recipe.has_feature("flow") { expected.regions.len() } else { 0 };
    assert_eq!(outcome.displacements.len(), displaced);
    for (index, region) in expected.regions.iter().enumerate() {
        for (feature, scores) in outcome.scores.iter().enumerate() {
            let name = recipe.features[feature].name;
            assert_eq!(scores[index], region.scores[feature] as u64, "{name} of region {index}");
        }
        if let Some(found) = outcome.displacements.get(index) {
            let found = (i64::from(found.dx), i64::from(found.dy));
            assert_eq!(found, region.displacement, "displacement of region {index}");
        }
        assert_eq!(i64::from(outcome.temporal_count[index]), region.temporal_count, "at {index}");
        assert_eq!(outcome.srs[index], region.srs, "srs of region {index}");
        assert_eq!(outcome.trs[index], region.trs, "trs of region {index}");
        assert_eq!(outcome.active[index], region.active, "active of region {index}");
        assert_eq!(outcome.actions[index].name(), region.action, "action of region {index}");
        let means: Vec<i64> = outcome.means[index].iter().map(|&mean| mean.into()).collect();
        assert_eq!(means, region.means, "means of region {index}");
    }
    assert_eq!(frame_values(&outcome.rendered), expected.rendered);
}

pub(crate) fn check(recipe: &DesignParameters, frames: &[Frame]) {
    let history = oracle_history(recipe, frames);
    let mut camera = FunctionalCamera::new(&recipe.camera());
    for (frame, expected) in frames.iter().zip(&history) {
        assert_outcome_is(recipe, camera.step(frame).unwrap(), expected);
    }
    // After a reset the camera decides as at the start.
    camera.reset();
    if let (Some(frame), Some(expected)) = (frames.first(), history.first()) {
        assert_outcome_is(recipe, camera.step(frame).unwrap(), expected);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(600)))]

    #[test]
    fn functional_equals_the_oracle(recipe in arbitrary_cameras(), script in arbitrary_scripts(7)) {
        check(&recipe, &make_clip(&recipe, &script));
    }

    /// The test checks the bound of the contract: the value that an irrelevant region shows in a
    /// block is within `level` of the mean of the block.
    #[test]
    fn every_block_that_is_shown_is_near_its_mean(
        recipe in arbitrary_cameras().prop_filter("a periphery", |recipe| recipe.periphery.is_some()),
        script in arbitrary_scripts(7),
    ) {
        // Without padding the whole of every block is on the screen.
        let (width, height) = (recipe.columns() * recipe.side, recipe.rows() * recipe.side);
        let recipe = DesignParameters { width, height, ..recipe };
        let design = recipe.camera();
        let mut camera = FunctionalCamera::new(&design);
        for frame in make_clip(&recipe, &script) {
            let outcome = camera.step(&frame).unwrap();
            for region in 0..design.regions() {
                if !outcome.srs[region as usize] {
                    check_shown(&recipe, outcome, &design, region);
                }
            }
        }
    }
}

fn check_shown(
    recipe: &DesignParameters,
    outcome: &FunctionalOutcome,
    design: &Camera,
    region: u32,
) {
    let PeripheryParameters { blocks, level } = recipe.periphery.unwrap();
    let side = (recipe.side / blocks) as u32;
    let (left, top) = (
        region % design.columns() * design.region_size(),
        region / design.columns() * design.region_size(),
    );
    let payload = outcome.payload(design);
    for block in 0..(blocks * blocks) as u32 {
        let (x, y) = (left + block % blocks as u32 * side, top + block / blocks as u32 * side);
        let places = || (y..y + side).flat_map(move |y| (x..x + side).map(move |x| (x, y)));
        let shown: Vec<i64> = places().map(|(x, y)| outcome.rendered.get(x, y).into()).collect();
        let sum: i64 = places().map(|(x, y)| i64::from(payload.get(x, y))).sum();
        assert!(shown.iter().all(|&value| value == shown[0]), "a block shows one value");
        let count = shown.len() as i64;
        // The shown value may differ from the exact mean by the level, plus half a grey level for
        // the rounding of the mean.
        let distance = (shown[0] * count - sum).abs();
        assert!(2 * distance <= (2 * level + 1) * count, "region {region}, block {block}");
    }
}
