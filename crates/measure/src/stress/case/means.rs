// SPDX-License-Identifier: MIT OR Apache-2.0
//! Means that end in exactly one half, or one pixel below or above it.

use foveate_camera::{Decimal, FeatureKind};
use foveate_model::FunctionalCamera;

use crate::stress::designs::{config, design};
use crate::stress::test_frames::frame_from_fn;
use crate::stress::{CaseRow, RunDepth};

/// Tests that for every sum around a half, the scores are those of the mean rounded up at one half.
/// In exact rational arithmetic the mean is `floor((2 sum + n) / (2 n))`.
pub(crate) fn halves(_: RunDepth) -> Vec<CaseRow> {
    [2, 3, 5, 8, 16].map(around_halves).into()
}

fn around_halves(side: u32) -> CaseRow {
    let mut config = config((side, side), side, 8, &[FeatureKind::Mad, FeatureKind::Segment]);
    config.camera.denoise.filter = foveate_camera::DenoiseFilter::None;
    for spatial in &mut config.camera.spatial {
        spatial.mean_fraction_bits = Some(0);
    }
    config.camera.spatial[1].level = Some(0);
    config.camera.spatial[1].min_score = Some(Decimal::from_whole(0));
    let design = design(&config);
    let n = design.region_pixels();
    let (mut wrong, mut tried, mut worst) = (0, 0, 0);
    for base in [0, 1, 127, 253] {
        for above in (n / 2).saturating_sub(2)..=(n / 2 + 2).min(n) {
            // `above` pixels are one level higher, so the mean is base + above / n.
            let region =
                frame_from_fn((side, side), 8, |x, y| base + u32::from(y * side + x < above));
            let mean = base + u32::from(2 * above >= n);
            let pixels = || region.pixels().iter().map(|&pixel| u32::from(pixel));
            let deviations: u64 = pixels().map(|pixel| u64::from(pixel.abs_diff(mean))).sum();
            let [higher, lower] =
                [pixels().filter(|&x| x > mean).count(), pixels().filter(|&x| x < mean).count()];
            let expected = [deviations, higher.min(lower) as u64];
            let mut camera = FunctionalCamera::new(&design);
            let outcome = camera.step(&region).expect("the region is a frame of the design");
            for (scores, expected) in outcome.scores.iter().zip(expected) {
                let error = scores[0].abs_diff(expected);
                (wrong, tried, worst) = (wrong + u64::from(error > 0), tried + 1, worst.max(error));
            }
        }
    }
    CaseRow::for_no_errors(
        "means on one half",
        format!("mad and segment, N {side}, f 0"),
        "scores wrong",
        (wrong, tried),
        worst,
    )
}
