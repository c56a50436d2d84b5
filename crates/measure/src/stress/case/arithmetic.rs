// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cases of the arithmetic of scores: the accumulators reach their derived maximum, and have
//! neither one bit too few nor one bit too many ([`largest_scores`]); the variance is right for
//! data with a large mean and a small spread, for which the sum of squares and the square of
//! the sum agree in their leading digits ([`large_mean_variance`]); and the division by a
//! reciprocal equals floor division for every input ([`reciprocals`]).

use crate::stress::designs::{
    RandomNumbers, config, design, frame_from_fn, kinds_for, organization_for,
};
use crate::stress::{CaseRow, RunDepth};
use foveate_camera::{FeatureKind, bits_for};
use foveate_design::Design;
use foveate_engine::Engine;
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;
use rayon::prelude::*;

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

/// Compares our integers and a single-pass variance in f32 with two passes in f64.
pub(crate) fn large_mean_variance(depth: RunDepth) -> Vec<CaseRow> {
    let regions = depth.choose(200, 5_000);
    [(8, 8), (32, 8), (8, 16), (64, 16)]
        .into_iter()
        .flat_map(|size| integer_and_f32_rows(size, regions))
        .collect()
}

fn integer_and_f32_rows((side, bits): (u32, u32), regions: u32) -> [CaseRow; 2] {
    let mut config = config((side, side), side, bits, &[FeatureKind::Variance]);
    config.camera.denoise.filter = foveate_camera::DenoiseFilter::None;
    let design = design(&config);
    let mut random = RandomNumbers::new(u64::from(side));
    let base = design.pixel_max() - 4;
    let (mut integer_error, mut f32_error) = (0.0_f64, 0.0_f64);
    for _ in 0..regions {
        let region = frame_from_fn((side, side), bits, {
            let spread: Vec<u32> = (0..design.region_pixels())
                .map(|_| u32::try_from(random.below(4)).expect("below 4"))
                .collect();
            move |x, y| base + spread[(y * side + x) as usize]
        });
        let exact = two_pass_variance(&region);
        let mut camera = FunctionalCamera::new(&design);
        let score = camera.step(&region).expect("the region is a frame of the design").scores[0][0];
        let n = f64::from(design.region_pixels());
        integer_error = integer_error.max((to_f64(score) / (n * n) - exact).abs() / exact);
        f32_error = f32_error.max((f64::from(single_pass_variance(&region)) - exact).abs() / exact);
    }
    let designs = format!("variance, N {side}, P {bits}, mean {}", base + 2);
    let row = |case, expected: &str, error: f64, holds| CaseRow {
        case,
        designs: designs.clone(),
        expected: expected.to_owned(),
        observed: format!("{:.2e} of it", error),
        worst: format!("{:.2e}", error),
        is_as_expected: holds,
    };
    // If the sum of squares fits into the 24 bits of an f32, it is exact.
    let cancels = bits_for(u64::from(design.region_pixels()) * u64::from(base + 3).pow(2)) > 24;
    [
        row("variance, integers", "error below 1e-9", integer_error, integer_error < 1e-9),
        row(
            "variance, single-pass f32 (not used)",
            if cancels { "error above 10 %" } else { "error below 10 %" },
            f32_error,
            (f32_error > 0.1) == cancels,
        ),
    ]
}

fn two_pass_variance(region: &Frame) -> f64 {
    let pixels = || region.pixels().iter().map(|&pixel| f64::from(pixel));
    let n = pixels().map(|_| 1.0).sum::<f64>();
    let mean = pixels().sum::<f64>() / n;
    pixels().map(|pixel| (pixel - mean) * (pixel - mean)).sum::<f64>() / n
}

fn single_pass_variance(region: &Frame) -> f32 {
    let (mut n, mut sum, mut squares) = (0.0_f32, 0.0_f32, 0.0_f32);
    for &pixel in region.pixels() {
        let pixel = f32::from(pixel);
        n += 1.0;
        sum += pixel;
        squares += pixel * pixel;
    }
    squares / n - (sum / n) * (sum / n)
}

#[allow(clippy::cast_precision_loss, reason = "compared within 1e-9")]
fn to_f64(value: u64) -> f64 {
    value as f64
}

/// Tests every N, powers of two included, for several P and f.
///
/// `(x * m) >> s` never falls as x grows, and neither does `floor(x / n)`. So the two are equal for
/// all x if they are equal at both ends of every run of x with the same quotient: at `q * n` and at
/// `q * n + n - 1`, for every q. Trying these values proves all others.
pub(crate) fn reciprocals(depth: RunDepth) -> Vec<CaseRow> {
    let kinds: &[(u32, u32)] = depth.choose(
        &[(8, 0), (10, 2), (16, 0)],
        &[(1, 0), (8, 0), (8, 6), (10, 2), (12, 4), (16, 0), (16, 4)],
    );
    kinds.iter().map(|&kind| reciprocal_row(kind)).collect()
}

fn reciprocal_row((bits, fraction_bits): (u32, u32)) -> CaseRow {
    let sides: Vec<u32> = (2..=64).filter(|side| fraction_limit(*side) >= fraction_bits).collect();
    let (wrong, tried, worst) = sides
        .par_iter()
        .map(|&side| try_every_quotient(side, bits, fraction_bits))
        .reduce(|| (0, 0, 0), |a, b| (a.0 + b.0, a.1 + b.1, a.2.max(b.2)));
    let designs = format!("{} sizes N, P {bits}, f {fraction_bits}", sides.len());
    CaseRow::for_no_errors(
        "mean by reciprocal, every dividend",
        designs,
        "quotients wrong",
        (wrong, tried),
        worst,
    )
}

/// Returns the largest number of fraction bits, ceil(log2 n).
fn fraction_limit(side: u32) -> u32 {
    u32::BITS - (side * side - 1).leading_zeros()
}

fn try_every_quotient(side: u32, bits: u32, fraction_bits: u32) -> (u64, u64, u64) {
    let mut config = config((side, side), side, bits, &[FeatureKind::Mad]);
    config.camera.spatial[0].mean_fraction_bits = Some(fraction_bits);
    let design = design(&config);
    let Some(reciprocal) = design.features()[0].mean().map(|mean| mean.reciprocal) else {
        return (1, 1, 1);
    };
    let (n, last) = (reciprocal.divisor(), reciprocal.x_max());
    let mut result = (0, 0, 0);
    for quotient in 0..=last / n {
        for x in [quotient * n, (quotient * n + n - 1).min(last)] {
            let error = reciprocal.divide(x).abs_diff(quotient);
            result = (result.0 + u64::from(error > 0), result.1 + 1, result.2.max(error));
        }
    }
    result
}
