// SPDX-License-Identifier: MIT OR Apache-2.0
//! The accumulators reach their derived maximum, and have neither one bit too few nor one bit too
//! many.

use foveate_camera::{FeatureKind, bits_for};
use foveate_design::Design;
use foveate_engine::Engine;
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;

use crate::stress::designs::{config, design, kinds_for, organization_for};
use crate::stress::test_frames::frame_from_fn;
use crate::stress::{CaseRow, RunDepth};

/// Tests the largest score of each feature that a known picture reaches, for the largest region and
/// for odd ones.
pub(crate) fn largest_scores(_: RunDepth) -> Vec<CaseRow> {
    let sizes = [(64, 16), (64, 8), (8, 8), (7, 16), (5, 10), (2, 1)];
    let rows_of_size = |size: (u32, u32)| {
        let kinds = kinds_for(size.0).into_iter().rev();
        kinds.filter_map(move |kind| largest_score_row(kind, size))
    };
    sizes.into_iter().flat_map(rows_of_size).collect()
}

/// Returns clips, one of which has the largest score in its last frame. Returns nothing if no such
/// clip is known.
fn extreme_clips(kind: FeatureKind, (side, bits): (u32, u32)) -> Vec<Vec<Frame>> {
    let (n, max) = (side * side, (1 << bits) - 1);
    let picture = |is_bright: &dyn Fn(u32, u32) -> bool| {
        frame_from_fn((side, side), bits, |x, y| if is_bright(x, y) { max } else { 0 })
    };
    match kind {
        // For an odd n, the best split has one pixel more on one side. The derivation of the width
        // decides which side it is; the case tries both, so that it does not depend on the
        // derivation.
        FeatureKind::Mad | FeatureKind::Variance | FeatureKind::Range | FeatureKind::Segment => {
            let halves = [n / 2, n.div_ceil(2)];
            halves.map(|ones| vec![picture(&|x, y| y * side + x < ones)]).into()
        }
        // Every pixel of the stripes changes, and the displaced stripes are equal.
        FeatureKind::Flow => {
            vec![[0, 1].map(|shift| picture(&|x, _| (x + shift).is_multiple_of(2))).into()]
        }
        // Hits of windows have a case of their own. The largest score of `surface` is only a bound,
        // because of three neighbors two are nearer to each other than half of the maximum.
        FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Surface => Vec::new(),
    }
}

fn largest_score_row(kind: FeatureKind, (side, bits): (u32, u32)) -> Option<CaseRow> {
    let mut config = config((side, side), side, bits, &[kind]);
    config.hardware.organization = organization_for(kind).into();
    config.camera.denoise.filter = foveate_camera::DenoiseFilter::None;
    if kind.has_second_pass() && kind.score_unit().is_count() {
        // Pixels of one bit have a mean of one half, which a whole number of grey levels would
        // round to one of both values.
        config.camera.spatial[0].mean_fraction_bits = Some(1);
    }
    let design = design(&config);
    let feature = &design.features()[0];
    let clips = extreme_clips(kind, (side, bits)).into_iter();
    let observed = clips.map(|clip| last_score(&design, &clip)).max()?;
    let is_tight = bits_for(observed) == feature.score_bits();
    let unit = if feature.score_bits() == 1 { "bit" } else { "bits" };
    let designs = format!("{kind}, N {side}, P {bits}: {} {unit}", feature.score_bits());
    let row =
        CaseRow::for_equal_numbers("largest score reached", designs, feature.score_max(), observed);
    Some(CaseRow { is_as_expected: row.is_as_expected && is_tight, ..row })
}

/// Returns the score of the last frame, or 0 if model and engine disagree.
fn last_score(design: &Design, clip: &[Frame]) -> u64 {
    let (mut camera, mut engine) = (FunctionalCamera::new(design), Engine::new(design));
    let mut scores = [None; 2];
    for frame in clip {
        scores = [
            camera.step(frame).ok().map(|outcome| outcome.scores[0][0]),
            engine.step(frame).ok().map(|outcome| outcome.scores[0][0]),
        ];
    }
    let [model_score, engine_score] = scores;
    model_score.filter(|_| model_score == engine_score).unwrap_or(0)
}

/// Tests the counts with a hit at every pixel of a region.
pub(crate) fn largest_counts(_: RunDepth) -> Vec<CaseRow> {
    let edge = |(side, bits): (u32, u32)| {
        let mut config = config((side, side), side, bits, &[FeatureKind::Edge]);
        config.camera.spatial[0].level = Some(0);
        config.camera.denoise.filter = foveate_camera::DenoiseFilter::None;
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
