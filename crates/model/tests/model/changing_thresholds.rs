// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of thresholds that change at any clock: each threshold must be used with its value at the
//! right clock.

use foveate_design::{Design, PipelinedTiming};
use foveate_model::{
    PipelinedRpu, RpuInput, ThresholdInputs,
    denoising::denoise,
    feature::{corner_strengths, edge_magnitudes},
    pad, region_border, region_stream, temporal_differences,
};
use foveate_pixels::Frame;
use proptest::prelude::*;

use crate::frames::{SeededRandom, arbitrary_scripts, make_clip};
use crate::oracle::{OracleOutcome, deviations, oracle_history, region_values, smaller_part};
use crate::parameters::{DesignParameters, arbitrary_parameters};
use crate::schedule::{tail_delay, tail_steps};

/// Returns the thresholds of one clock. Each threshold has either the value of the design or a
/// random value that fits its port.
fn jittered_thresholds(design: &Design, random: &mut SeededRandom) -> ThresholdInputs {
    let mut thresholds = ThresholdInputs::from_camera(design);
    let mut pick = |designed: u64, bits: u32| {
        if random.below(3) == 0 { random.below(1 << bits) as u64 } else { designed }
    };
    for (index, feature) in design.features().iter().enumerate() {
        if feature.level().is_some() {
            let designed = thresholds.level[index].into();
            thresholds.level[index] = pick(designed, feature.level_bits()) as u32;
        }
        thresholds.min_score[index] = pick(thresholds.min_score[index], feature.score_bits());
    }
    let designed = thresholds.temporal_level.into();
    thresholds.temporal_level = pick(designed, design.pixel_bits()) as u32;
    let designed = thresholds.temporal_min_count.into();
    thresholds.temporal_min_count = pick(designed, design.count_bits()) as u32;
    let designed = thresholds.summary_level.into();
    thresholds.summary_level = pick(designed, design.pixel_bits()) as u32;
    thresholds
}

/// The expected scores and decisions of a clip whose thresholds change at every clock.
struct ThresholdHistory<'a> {
    recipe: &'a DesignParameters,
    design: Design,
    denoised: Vec<Frame>,
    history: Vec<OracleOutcome>,
    steps: Vec<Vec<usize>>,
    applied: Vec<ThresholdInputs>,
}

/// SRS and active of a finished frame, as the registers took them.
type RegisteredDecision = (bool, bool);

impl ThresholdHistory<'_> {
    fn scores(&self, frame: usize) -> Vec<u64> {
        let hits = |index: usize, hit: &dyn Fn(usize, u32) -> bool| {
            let level = |step: usize| self.applied[step - tail_delay(self.recipe)].level[index];
            let steps = self.steps[frame].iter().enumerate();
            steps.filter(|&(place, &step)| hit(place, level(step))).count() as u64
        };
        let score = |(index, name): (usize, &str)| match name {
            "edge" => {
                let magnitudes = edge_magnitudes(&self.design, &self.denoised[frame], 0);
                hits(index, &|place, level| magnitudes[place] > level)
            }
            "corner" => {
                let strengths = corner_strengths(&self.design, &self.denoised[frame], 0);
                hits(index, &|place, level| strengths[place].is_some_and(|s| level <= s))
            }
            "segment" => self.segment_score(frame, index),
            _ => self.history[frame].regions[0].scores[index] as u64,
        };
        self.recipe.features.iter().map(|feature| feature.name).enumerate().map(score).collect()
    }

    /// Returns the score of `segment`: a pixel is compared at its step of the second pass.
    fn segment_score(&self, frame: usize, index: usize) -> u64 {
        let feature = &self.recipe.features[index];
        let deviations = deviations(self.recipe, feature, &self.history[frame].denoised, 0);
        let side = |(deviation, &step): (i64, &usize)| {
            let level = i64::from(self.applied[step].level[index]) << feature.fraction_bits;
            deviation.signum() * i64::from(deviation.abs() > level)
        };
        let sides: Vec<_> = deviations.into_iter().zip(&self.steps[frame + 1]).map(side).collect();
        smaller_part(&sides) as u64
    }

    fn temporal_count(&self, frame: usize, registered: &[RegisteredDecision]) -> u32 {
        let reference = if self.recipe.last_sent {
            let decisive = |&at: &usize| {
                let (srs, active) = registered[at];
                active || self.recipe.drops_irrelevant_pixels() && !srs
            };
            (0..frame).rev().find(decisive).filter(|&at| registered[at].1)
        } else {
            frame.checked_sub(1)
        };
        let Some(reference) = reference else { return self.design.region_pixels() };
        let (current, referenced) = (&self.denoised[frame], &self.denoised[reference]);
        let differences = temporal_differences(&self.design, current, referenced, 0);
        let level = |step: &usize| self.applied[*step].temporal_level;
        let pairs = differences.iter().zip(&self.steps[frame]);
        pairs.map(|(&difference, step)| u32::from(difference > level(step))).sum()
    }

    fn decide(&self, scores: &[u64], count: u32, clock: usize) -> (bool, bool) {
        let thresholds = &self.applied[clock];
        let mut votes = scores.iter().zip(thresholds.min_score).map(|(&score, min)| score >= min);
        let srs = if self.recipe.all_must_vote { votes.all(|v| v) } else { votes.any(|v| v) };
        (srs, count >= thresholds.temporal_min_count)
    }
}

fn check(recipe: &DesignParameters, clip: &[Frame], seed: u64) -> Result<(), TestCaseError> {
    let design = recipe.design();
    let mut random = SeededRandom(seed);
    // Pixels come with random gaps, and every edge has its own inputs.
    let mut stream = Vec::new();
    let mut inputs = Vec::new();
    for frame in clip {
        let mut pixels = Vec::new();
        region_stream(&design, frame, 0, &mut pixels);
        let mut edges = Vec::new();
        for pixel in pixels {
            inputs.extend((0..random.below(9) / 7 * random.below(8)).map(|_| None));
            edges.push(inputs.len());
            inputs.push(Some(pixel));
        }
        stream.push(edges);
    }
    inputs.extend(vec![
        None;
        PipelinedTiming::from_design(design.as_pipelined().unwrap()).decision_latency
            as usize
            + 3
    ]);
    let frames = ThresholdHistory {
        recipe,
        denoised: clip.iter().map(|f| denoise(&design, &pad(&design, f).unwrap())).collect(),
        history: oracle_history(recipe, clip),
        steps: tail_steps(recipe, &stream),
        applied: inputs.iter().map(|_| jittered_thresholds(&design, &mut random)).collect(),
        design: design.clone(),
    };

    let mut rpu = PipelinedRpu::new(design.as_pipelined().unwrap());
    let border = region_border(&design, 0);
    let mut decisions = Vec::new();
    let mut sent_values = Vec::new();
    for (pixel, thresholds) in inputs.iter().zip(&frames.applied) {
        let (valid, pixel) = (pixel.is_some(), pixel.unwrap_or_default());
        let output = rpu.step(&RpuInput { reset: false, valid, pixel, border }, thresholds);
        decisions.extend(output.decision_valid.then_some(output));
        sent_values.extend(output.forward_valid.then(|| i64::from(output.forward_pixel)));
    }

    let wait = usize::from(recipe.has_second_pass());
    let mut registered = Vec::new();
    let mut leaving = Vec::new();
    let mut shown: Option<Vec<i64>> = None;
    let decided = clip.len() - wait.min(clip.len());
    prop_assert_eq!(decisions.len(), decided);
    for (frame, decision) in decisions.iter().enumerate() {
        let done = *frames.steps[frame + wait].last().unwrap();
        let (scores, count) = (frames.scores(frame), frames.temporal_count(frame, &registered));
        prop_assert_eq!(&decision.scores[..scores.len()], &scores[..]);
        prop_assert_eq!(decision.temporal_count, count);
        // The outputs show the decision with the thresholds of the edge before, and the registers
        // take it with those of the edge that ends the clock.
        prop_assert_eq!((decision.srs, decision.trs), frames.decide(&scores, count, done));
        let (srs, trs) = frames.decide(&scores, count, done + 1);
        registered.push((srs, srs && trs));
        let means = &frames.history[frame].regions[0].means;
        let is_due = |srs: bool, clock: usize| {
            let level = i64::from(frames.applied[clock].summary_level);
            let is_near = |shown: &Vec<i64>| {
                shown.iter().zip(means).all(|(shown, mean)| (shown - mean).abs() <= level)
            };
            recipe.periphery.is_some() && !srs && !shown.as_ref().is_some_and(is_near)
        };
        prop_assert_eq!(decision.summary, is_due(decision.srs, done));
        if is_due(srs, done + 1) {
            shown = Some(means.clone());
            if frame + wait + 1 < clip.len() {
                leaving.extend(means);
            }
        } else if srs && trs {
            shown = None;
        }
        if srs && trs && frame + wait + 1 < clip.len() {
            let frame_outcome = &frames.history[frame];
            let payload =
                if recipe.raw_payload { &frame_outcome.padded } else { &frame_outcome.denoised };
            leaving.extend(region_values(recipe, payload, 0));
        }
    }
    prop_assert_eq!(sent_values, leaving);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(400)))]

    #[test]
    fn each_threshold_counts_in_its_own_clock(
        recipe in arbitrary_parameters(),
        script in arbitrary_scripts(6),
        seed in any::<u64>(),
    ) {
        let one_region = DesignParameters {
            width: recipe.width.min(recipe.side),
            height: recipe.height.min(recipe.side),
            constant: false,
            ..recipe
        };
        check(&one_region, &make_clip(&one_region, &script), seed)?;
    }

    #[test]
    fn inputs_that_a_design_lacks_have_no_effect(recipe in arbitrary_parameters(), script in arbitrary_scripts(4), seed in any::<u64>()) {
        let design = DesignParameters { constant: true, ..recipe.clone() }.design();
        let mut random = SeededRandom(seed);
        let (mut plain, mut with_ignored_inputs) = (PipelinedRpu::new(design.as_pipelined().unwrap()), PipelinedRpu::new(design.as_pipelined().unwrap()));
        for frame in make_clip(&recipe, &script) {
            let mut pixels = Vec::new();
            region_stream(&design, &frame, 0, &mut pixels);
            for pixel in pixels {
                let input = RpuInput { valid: true, pixel, ..RpuInput::default() };
                let jittered = jittered_thresholds(&design, &mut random);
                let border = if design.needs_border() { 0 } else { random.below(16) as u8 };
                let expected = plain.step(&input, &ThresholdInputs::from_camera(&design));
                prop_assert_eq!(with_ignored_inputs.step(&RpuInput { border, ..input }, &jittered), expected);
            }
        }
    }
}
