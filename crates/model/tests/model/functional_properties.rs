// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functional model equals the oracle, for every kind of design.

use foveate_frame::Frame;
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use proptest::prelude::*;

use crate::frames::{film, scripts};
use crate::oracle::{Image, Seen, watch};
use crate::recipe::{Recipe, recipes};

fn image(frame: &Frame) -> Image {
    let row = |y| frame.row(y).iter().map(|&pixel| i64::from(pixel)).collect();
    (0..frame.height()).map(row).collect()
}

pub(crate) fn assert_same(recipe: &Recipe, outcome: &FunctionalOutcome, seen: &Seen) {
    assert_eq!(image(&outcome.padded), seen.padded);
    assert_eq!(image(&outcome.denoised), seen.denoised);
    for (index, region) in seen.regions.iter().enumerate() {
        for (feature, scores) in outcome.scores.iter().enumerate() {
            let name = recipe.features[feature].name;
            assert_eq!(scores[index], region.scores[feature] as u64, "{name} of region {index}");
        }
        assert_eq!(i64::from(outcome.temporal_count[index]), region.temporal_count, "at {index}");
        assert_eq!(outcome.srs[index], region.srs, "srs of region {index}");
        assert_eq!(outcome.trs[index], region.trs, "trs of region {index}");
        assert_eq!(outcome.active[index], region.active, "active of region {index}");
        assert_eq!(outcome.actions[index].name(), region.action, "action of region {index}");
    }
    assert_eq!(image(&outcome.rendered), seen.rendered);
}

pub(crate) fn check(recipe: &Recipe, frames: &[Frame]) {
    let history = watch(recipe, frames);
    let mut camera = FunctionalCamera::new(&recipe.design());
    for (frame, seen) in frames.iter().zip(&history) {
        assert_same(recipe, camera.step(frame).unwrap(), seen);
    }
    // A reset forgets everything.
    camera.reset();
    if let (Some(frame), Some(seen)) = (frames.first(), history.first()) {
        assert_same(recipe, camera.step(frame).unwrap(), seen);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn functional_equals_the_oracle(recipe in recipes(), script in scripts(7)) {
        check(&recipe, &film(&recipe, &script));
    }
}
