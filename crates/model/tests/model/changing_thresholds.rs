// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of thresholds that change at any clock: each threshold must be used with its value at the
//! right clock.

use foveate_design::{Design, PipelinedTiming};
use foveate_model::{PipelinedRpu, RpuInput, ThresholdInputs, region_border, region_stream};
use foveate_pixels::Frame;
use proptest::prelude::*;

use crate::frames::{SeededRandom, arbitrary_scripts, make_clip};
use crate::oracle::{
    OracleOutcome, OracleRegion, action, oracle_region, outcome_without_regions, score_of_terms,
};
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

/// Returns the results of the oracle for the only region of the next frame. The tail steps of the
/// frame and of the one behind it have these clocks, and every pixel is compared with the levels
/// that are applied at its own clock.
fn measured_region(
    recipe: &DesignParameters,
    history: &[OracleOutcome],
    frame: &OracleOutcome,
    (own_steps, later_steps): (&[usize], &[usize]),
    applied: &[ThresholdInputs],
) -> OracleRegion {
    let with = |recipe: &DesignParameters| oracle_region(recipe, (history, history), frame, 0);
    let mut region = with(recipe);
    for (position, (&own, &later)) in own_steps.iter().zip(later_steps).enumerate() {
        let mut recipe = recipe.clone();
        let window = own - tail_delay(&recipe);
        recipe.temporal_level = applied[own].temporal_level.into();
        for (index, feature) in recipe.features.iter_mut().enumerate() {
            let clock = if feature.name == "segment" { later } else { window };
            feature.level = applied[clock].level[index].into();
        }
        let at_position = with(&recipe);
        region.temporal_hits[position] = at_position.temporal_hits[position];
        for (terms, at_position) in region.terms.iter_mut().zip(at_position.terms) {
            terms[position] = at_position[position];
        }
    }
    region.temporal_count = region.temporal_hits.iter().filter(|&&hit| hit).count() as i64;
    for (index, feature) in recipe.features.iter().enumerate() {
        if feature.has_level() {
            region.scores[index] = score_of_terms(feature.name, &region.terms[index]);
        }
    }
    region
}

/// Sets the decision of the region with the minima and the level of summaries of one clock.
fn decide(
    recipe: &DesignParameters,
    history: &[OracleOutcome],
    region: &mut OracleRegion,
    thresholds: &ThresholdInputs,
) {
    let minima = thresholds.min_score.map(|minimum| minimum as i64);
    let mut votes = region.scores.iter().zip(minima).map(|(&score, minimum)| score >= minimum);
    region.srs = if recipe.all_must_vote { votes.all(|v| v) } else { votes.any(|v| v) };
    region.trs = region.temporal_count >= thresholds.temporal_min_count.into();
    region.active = region.srs && region.trs;
    let mut recipe = recipe.clone();
    recipe.periphery.iter_mut().for_each(|own| own.level = thresholds.summary_level.into());
    region.action = action(&recipe, history, 0, (region.srs, region.trs), &region.means);
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
    let steps = tail_steps(recipe, &stream);
    let applied: Vec<ThresholdInputs> =
        inputs.iter().map(|_| jittered_thresholds(&design, &mut random)).collect();

    let mut rpu = PipelinedRpu::new(design.as_pipelined().unwrap());
    let border = region_border(&design, 0);
    let mut decisions = Vec::new();
    let mut sent_values = Vec::new();
    for (pixel, thresholds) in inputs.iter().zip(&applied) {
        let (valid, pixel) = (pixel.is_some(), pixel.unwrap_or_default());
        let output = rpu.step(&RpuInput { reset: false, valid, pixel, border }, thresholds);
        decisions.extend(output.decision_valid.then_some(output));
        sent_values.extend(output.forward_valid.then(|| i64::from(output.forward_pixel)));
    }

    let wait = usize::from(recipe.has_second_pass());
    let mut history: Vec<OracleOutcome> = Vec::new();
    let mut leaving = Vec::new();
    prop_assert_eq!(decisions.len(), clip.len().saturating_sub(wait));
    for (frame, decision) in decisions.iter().enumerate() {
        let mut outcome = outcome_without_regions(recipe, &clip[frame]);
        let clocks = (&steps[frame][..], &steps[frame + wait][..]);
        let mut region = measured_region(recipe, &history, &outcome, clocks, &applied);
        let scores: Vec<_> = region.scores.iter().map(|&score| score as u64).collect();
        prop_assert_eq!(&decision.scores[..scores.len()], &scores[..]);
        prop_assert_eq!(i64::from(decision.temporal_count), region.temporal_count);
        // The outputs show the decision with the thresholds of the edge before, and the registers
        // take it with those of the edge that ends the clock.
        let done = *steps[frame + wait].last().unwrap();
        decide(recipe, &history, &mut region, &applied[done]);
        prop_assert_eq!((decision.srs, decision.trs), (region.srs, region.trs));
        prop_assert_eq!(decision.summary, region.action == "summarize");
        decide(recipe, &history, &mut region, &applied[done + 1]);
        if frame + wait + 1 < clip.len() {
            match region.action {
                "forward" => leaving.extend(&region.payload),
                "summarize" => leaving.extend(&region.means),
                _ => {}
            }
        }
        outcome.regions.push(region);
        history.push(outcome);
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
