// SPDX-License-Identifier: MIT OR Apache-2.0
//! The accumulators reach their derived maximum, and have neither one bit too few nor one bit too
//! many.

use foveate_design::{FeatureKind, bits_for};
use foveate_engine::Engine;
use foveate_model::FunctionalCamera;

use crate::designs::{config, design};
use crate::test_frames::frame_from_fn;
use crate::{CaseRow, RunDepth};

/// Tests the scores with half of the pixels at the maximum and the others at zero, for the largest
/// region and for odd ones.
pub(crate) fn largest_scores(_: RunDepth) -> Vec<CaseRow> {
    let sizes = [(64, 16), (64, 8), (8, 8), (7, 16), (5, 10), (2, 1)];
    let mut kinds = FeatureKind::ALL.to_vec();
    kinds.retain(|&kind| is_largest_for_halves(kind));
    let rows_of_size = |size| kinds.iter().rev().map(move |&kind| largest_score_row(kind, size));
    sizes.into_iter().flat_map(rows_of_size).collect()
}

/// Returns true if the score is the largest one where a region has two equal parts.
fn is_largest_for_halves(kind: FeatureKind) -> bool {
    match kind {
        FeatureKind::Mad | FeatureKind::Variance | FeatureKind::Range | FeatureKind::Segment => {
            true
        }
        // Hits of windows have a case of their own. The largest score of `surface` is only a bound,
        // because of three neighbors two are nearer to each other than half of the maximum. That of
        // `flow` needs two frames.
        FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Surface | FeatureKind::Flow => false,
    }
}

fn largest_score_row(kind: FeatureKind, (side, bits): (u32, u32)) -> CaseRow {
    let mut config = config((side, side), side, bits, &[kind]);
    config.camera.denoise.filter = foveate_design::DenoiseFilter::None;
    if kind.has_second_pass() && kind.score_unit().is_count() {
        // Pixels of one bit have a mean of one half, which a whole number of grey levels would
        // round to one of both values.
        config.camera.spatial[0].mean_fraction_bits = Some(1);
    }
    let design = design(&config);
    let max = design.pixel_max();
    let n = design.region_pixels();
    let feature = &design.features()[0];
    // For an odd n, the best split has one pixel more on one side. The derivation of the width
    // decides which side it is; the case tries both, so that it does not depend on the derivation.
    let scores = [n / 2, n.div_ceil(2)].map(|ones| {
        let half =
            frame_from_fn((side, side), bits, |x, y| if y * side + x < ones { max } else { 0 });
        let model_score =
            FunctionalCamera::new(&design).step(&half).map(|outcome| outcome.scores[0][0]);
        let engine_score = Engine::new(&design).step(&half).map(|outcome| outcome.scores[0][0]);
        // If the two disagree, the score is not valid.
        model_score.ok().filter(|model_score| engine_score.ok() == Some(*model_score)).unwrap_or(0)
    });
    let [low, high] = scores;
    let observed = low.max(high);
    let is_tight = bits_for(observed) == feature.score_bits();
    let designs = format!("{kind}, N {side}, P {bits}: {} bits", feature.score_bits());
    let row =
        CaseRow::for_equal_numbers("largest score reached", designs, feature.score_max(), observed);
    CaseRow { is_as_expected: row.is_as_expected && is_tight, ..row }
}

/// Tests the counts with a hit at every pixel of a region.
pub(crate) fn largest_counts(_: RunDepth) -> Vec<CaseRow> {
    let edge = |(side, bits): (u32, u32)| {
        let mut config = config((side, side), side, bits, &[FeatureKind::Edge]);
        config.camera.spatial[0].level = Some(0);
        config.camera.denoise.filter = foveate_design::DenoiseFilter::None;
        let design = design(&config);
        // A slope has a gradient everywhere, also in the clamped windows of the border.
        let slope = frame_from_fn((side, side), bits, |x, _| x * design.pixel_max() / (side - 1));
        let outcome = FunctionalCamera::new(&design)
            .step(&slope)
            .map(|outcome| (outcome.scores[0][0], u64::from(outcome.temporal_count[0])));
        let (hits, changed) = outcome.expect("the slope is a frame of the design");
        let n = u64::from(design.region_pixels());
        let designs = format!("edge and temporal, N {side}, P {bits}");
        CaseRow::for_equal_numbers("count reaches n", designs, 2 * n, hits + changed)
    };
    [(64, 16), (64, 8), (8, 8), (3, 8)].map(edge).into()
}
