// SPDX-License-Identifier: MIT OR Apache-2.0
//! Thresholds at a measured value, one below and one above it.

use foveate_camera::{Decimal, DenoiseFilter, FeatureKind};
use foveate_design::DesignConfig;
use foveate_engine::Engine;
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;

use crate::stress::designs::{RandomNumbers, config, design, organization_for};
use crate::stress::{CaseRow, RunDepth};

/// Tests that a score votes if the minimum is equal to it and not if it is one higher, or higher by
/// the last digit of a decimal, and that a pixel is a hit if the level is one below its magnitude
/// and not if it is equal.
pub(crate) fn on_below_above(depth: RunDepth) -> Vec<CaseRow> {
    let rounds = depth.choose(12, 200);
    let scored = FeatureKind::ALL.iter().map(|&kind| score_thresholds(kind, rounds));
    scored.chain([edge_levels(rounds), temporal_thresholds(rounds)]).collect()
}

const SIDE: u32 = 8;

fn config_without_filter(feature: FeatureKind) -> DesignConfig {
    let mut config = config((SIDE, SIDE), SIDE, 8, &[feature]);
    config.hardware.organization = organization_for(feature).into();
    config.camera.denoise.filter = DenoiseFilter::None;
    config
}

/// Returns a value of the outcome of the second of two frames. The two functions read the value
/// from the outcomes of the model and of the engine. Returns `None` if the two values differ.
fn compare_answers<A: PartialEq>(
    config: &DesignConfig,
    frames: [&Frame; 2],
    model_answer: impl Fn(&foveate_model::FunctionalOutcome) -> A,
    engine_answer: impl Fn(&foveate_engine::FrameOutcome) -> A,
) -> Option<A> {
    let design = design(config);
    let (mut camera, mut engine) = (FunctionalCamera::new(&design), Engine::new(&design));
    camera.step(frames[0]).ok()?;
    engine.step(frames[0]).ok()?;
    let model_answer = model_answer(camera.step(frames[1]).ok()?);
    (model_answer == engine_answer(engine.step(frames[1]).ok()?)).then_some(model_answer)
}

/// Makes a row from the results of trials, each true if the trial is right.
fn threshold_row(designs: &str, what: &str, answers: &[bool]) -> CaseRow {
    let wrong = answers.iter().map(|&is_right| u64::from(!is_right)).sum();
    CaseRow::for_no_errors(
        "thresholds on, below, above",
        designs,
        what,
        (wrong, answers.len() as u64),
        u8::from(wrong > 0),
    )
}

fn score_thresholds(kind: FeatureKind, rounds: u64) -> CaseRow {
    /// The smallest step of a decimal is a billionth.
    const UNIT: u64 = 1_000_000_000;
    let mut answers = Vec::new();
    for seed in 0..rounds {
        let frame = RandomNumbers::new(seed).frame((SIDE, SIDE), 8);
        // Only a feature that compares a region with its reference sees the frame before.
        let before = RandomNumbers::new(seed + rounds).frame((SIDE, SIDE), 8);
        let mut config = config_without_filter(kind);
        if kind.score_unit().is_count() {
            config.camera.spatial[0].level = Some(40);
        }
        let frames = [&before, &frame];
        let score = compare_answers(&config, frames, |o| o.scores[0][0], |o| o.scores[0][0]);
        let Some(score) = score else {
            answers.push(false);
            continue;
        };
        let design = design(&config);
        let feature = &design.features()[0];
        // The decimal of a score is rounded down, and is still above the score before.
        let decimal = |score: u64| score * UNIT / feature.unit();
        let step = if kind.score_unit().is_count() { UNIT } else { 1 };
        let minima = [decimal(score.saturating_sub(1)), decimal(score), decimal(score) + step];
        for billionths in minima.into_iter().filter(|own| *own <= decimal(feature.score_max())) {
            config.camera.spatial[0].min_score = Some(Decimal::from_billionths(billionths));
            let voted = compare_answers(&config, frames, |o| o.srs[0], |o| o.srs[0]);
            answers.push(voted == Some(billionths <= decimal(score)));
        }
    }
    threshold_row(&format!("{kind}, N {SIDE}, min_score"), "votes wrong", &answers)
}

/// Tests the level of `edge` with steps in brightness of different height.
fn edge_levels(rounds: u64) -> CaseRow {
    let mut answers = Vec::new();
    for step in 1..=rounds.min(255) {
        let step = u32::try_from(step).expect("at most 255");
        // At a vertical step of brightness, |Gx| is four times its height in the two columns beside
        // it.
        let frame =
            crate::stress::designs::frame_from_fn(
                (SIDE, SIDE),
                8,
                |x, _| {
                    if x < 4 { 0 } else { step }
                },
            );
        for level in [4 * step - 1, 4 * step, 4 * step + 1] {
            let mut config = config_without_filter(FeatureKind::Edge);
            config.camera.spatial[0].level = Some(level);
            let hits =
                compare_answers(&config, [&frame, &frame], |o| o.scores[0][0], |o| o.scores[0][0]);
            let expected = if 4 * step > level { 2 * SIDE } else { 0 };
            answers.push(hits == Some(expected.into()));
        }
    }
    threshold_row(&format!("edge, N {SIDE}, level"), "hits wrong", &answers)
}

/// Tests the temporal level and count with a known difference in a known number of pixels.
fn temporal_thresholds(rounds: u64) -> CaseRow {
    let mut answers = Vec::new();
    for seed in 0..rounds {
        let mut random = RandomNumbers::new(seed);
        let changed = random.below(u64::from(SIDE * SIDE) + 1);
        let changed = u32::try_from(changed).expect("at most the pixels of a region");
        let difference = 1 + u32::try_from(random.below(200)).expect("below 200");
        let base_frame = crate::stress::designs::frame_from_fn((SIDE, SIDE), 8, |_, _| 20);
        let changed_frame = crate::stress::designs::frame_from_fn((SIDE, SIDE), 8, |x, y| {
            if y * SIDE + x < changed { 20 + difference } else { 20 }
        });
        for level in [difference - 1, difference, difference + 1] {
            for min in [changed.saturating_sub(1), changed, (changed + 1).min(SIDE * SIDE)] {
                let mut config = config_without_filter(FeatureKind::Edge);
                (config.camera.temporal.level, config.camera.temporal.min_count) =
                    (Some(level), min);
                let trs = compare_answers(
                    &config,
                    [&base_frame, &changed_frame],
                    |o| o.trs[0],
                    |o| o.trs[0],
                );
                let count = if difference > level { changed } else { 0 };
                answers.push(trs == Some(count >= min));
            }
        }
    }
    threshold_row(&format!("temporal, N {SIDE}, level and min_count"), "TRS wrong", &answers)
}
