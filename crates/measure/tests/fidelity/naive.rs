// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every figure against a count pixel by pixel, for made-up results of any two cameras.

use foveate_camera::{Camera, RegionAction};
use foveate_engine::FrameOutcome;
use foveate_ideal::IdealOutcome;
use foveate_measure::{CandidateFrame, Fidelity, FidelityFigures, FrameOrder, Staleness};
use foveate_pixels::{ByteFrame, convert_depth};
use proptest::prelude::*;

use crate::likeness::{check_pictures, mean};
use crate::results::{
    RandomNumbers, blank_ideal, blank_outcome, config, frame_from_words, greys, pixels,
};

/// The data that is added for one frame.
pub(crate) struct MadeUpFrame {
    pub(crate) input: Vec<u16>,
    pub(crate) ideal: IdealOutcome,
    candidate: FrameOutcome,
    /// The screen at the depth of the candidate.
    screen: Vec<u16>,
    /// The candidate's denoised frame at its depth.
    denoised: Vec<u16>,
}

/// Returns pixels of which half equal those of `base`, so that no figure is at the end of its
/// range.
fn nearby_pixels(random: &mut RandomNumbers, base: &[u16], from: u32, to: u32) -> Vec<u16> {
    let max = (1_u32 << to) - 1;
    base.iter()
        .map(|&pixel| match random.coin() {
            true => convert_depth(pixel, from, to),
            false => random.pixel(max),
        })
        .collect()
}

fn made_up(
    random: &mut RandomNumbers,
    ideal_camera: &Camera,
    candidate_camera: &Camera,
) -> MadeUpFrame {
    let (bits, max) = (ideal_camera.pixel_bits(), ideal_camera.pixel_max());
    let input: Vec<u16> = (0..pixels(ideal_camera)).map(|_| random.pixel(max)).collect();
    let actions = [RegionAction::Forward, RegionAction::Hold, RegionAction::Blank];
    let mut ideal = blank_ideal(ideal_camera);
    for region in 0..ideal.srs.len() {
        (ideal.srs[region], ideal.trs[region]) = (random.below(3) > 0, random.coin());
        ideal.actions[region] = actions[random.below(2) as usize];
        ideal.scores[0][region] = f64::from(random.below(ideal_camera.region_pixels()));
        ideal.changed[region] = f64::from(random.below(ideal_camera.region_pixels()));
    }
    ideal.denoised = greys(&nearby_pixels(random, &input, bits, bits));
    ideal.rendered = greys(&nearby_pixels(random, &input, bits, bits));
    let mut candidate = blank_outcome(candidate_camera);
    for region in 0..candidate.srs.len() {
        (candidate.srs[region], candidate.trs[region]) = (random.coin(), random.below(3) > 0);
        candidate.actions[region] = actions[random.below(2) as usize];
        candidate.scores[0][region] = random.below(candidate_camera.region_pixels()).into();
        candidate.temporal_count[region] = random.below(candidate_camera.region_pixels());
    }
    let screen = nearby_pixels(random, &input, bits, candidate_camera.pixel_bits());
    let mut denoised = screen.clone();
    denoised.iter_mut().filter(|_| random.below(3) == 0).for_each(|pixel| *pixel = 0);
    MadeUpFrame { input, ideal, candidate, screen, denoised }
}

/// Returns the number of the region of a pixel.
fn region(camera: &Camera, x: u32, y: u32) -> usize {
    let side = camera.region_size();
    (y / side * camera.columns() + x / side) as usize
}

fn share(part: f64, whole: f64, empty: f64) -> f64 {
    if whole == 0.0 { empty } else { part / whole }
}

/// Checks the figures of decisions, pixel by pixel.
fn check_decisions(
    figures: &FidelityFigures,
    frames: &[MadeUpFrame],
    ideal_camera: &Camera,
    candidate_camera: &Camera,
) {
    let mut counts = [0.0; 11];
    let [
        all,
        srs,
        trs,
        action,
        ideal_active,
        candidate_active,
        both,
        either,
        missed,
        false_alarms,
        later_ideal,
    ] = &mut counts;
    let mut later_candidate = 0.0;
    for (number, MadeUpFrame { ideal, candidate, .. }) in frames.iter().enumerate() {
        for (x, y) in
            (0..ideal_camera.height()).flat_map(|y| (0..ideal_camera.width()).map(move |x| (x, y)))
        {
            let (a, b) = (region(ideal_camera, x, y), region(candidate_camera, x, y));
            let as_count = |yes: bool| f64::from(u8::from(yes));
            *all += 1.0;
            *srs += as_count(ideal.srs[a] != candidate.srs[b]);
            *trs += as_count(ideal.trs[a] != candidate.trs[b]);
            *action += as_count(ideal.actions[a] != candidate.actions[b]);
            let active = (ideal.srs[a] && ideal.trs[a], candidate.srs[b] && candidate.trs[b]);
            *ideal_active += as_count(active.0);
            *candidate_active += as_count(active.1);
            *both += as_count(active.0 && active.1);
            *either += as_count(active.0 || active.1);
            if number > 0 {
                *missed += as_count(active.0 && !active.1);
                *false_alarms += as_count(active.1 && !active.0);
                *later_ideal += as_count(active.0);
                later_candidate += as_count(active.1);
            }
        }
    }
    let [
        all,
        srs,
        trs,
        action,
        ideal_active,
        candidate_active,
        both,
        either,
        missed,
        false_alarms,
        later_ideal,
    ] = counts;
    let expected = [
        (figures.srs_flips, srs / all),
        (figures.trs_flips, trs / all),
        (figures.action_flips, action / all),
        (figures.missed, share(missed, later_ideal, 0.0)),
        (figures.false_alarms, share(false_alarms, later_candidate, 0.0)),
        (figures.active_iou, share(both, either, 1.0)),
        (figures.active, candidate_active / all),
        (figures.ideal_active, ideal_active / all),
    ];
    for (at, (figure, expected)) in expected.into_iter().enumerate() {
        assert_eq!(figure, expected, "decision {at}");
    }
}

/// Checks the staleness, pixel by pixel; `shown` are the screens at the depth of the ideal.
fn check_staleness(
    figures: &FidelityFigures,
    frames: &[MadeUpFrame],
    shown: &[Vec<u16>],
    (ideal_camera, candidate_camera): (&Camera, &Camera),
) {
    let own = |frame: &MadeUpFrame| -> Vec<f64> {
        let (from, to) = (candidate_camera.pixel_bits(), ideal_camera.pixel_bits());
        frame.denoised.iter().map(|&pixel| f64::from(convert_depth(pixel, from, to))).collect()
    };
    let denoised: Vec<_> = frames.iter().map(|frame| frame.ideal.denoised.clone()).collect();
    let to_ideal = staleness(frames, (&denoised, shown), ideal_camera);
    assert_eq!(figures.staleness, to_ideal);
    let denoised: Vec<_> = frames.iter().map(own).collect();
    let to_own = staleness(frames, (&denoised, shown), ideal_camera);
    assert_eq!(figures.stale_regions, to_own.share);
}

/// Returns the difference between the screens and denoised frames.
fn staleness(
    frames: &[MadeUpFrame],
    (denoised, shown): (&[Vec<f64>], &[Vec<u16>]),
    ideal_camera: &Camera,
) -> Staleness {
    let (mut max, mut sum, mut relevant_pixels) = (0.0_f64, 0.0, 0.0);
    let (mut relevant, mut stale, mut longest) = (0.0, 0.0, 0);
    let mut runs = vec![0_u64; ideal_camera.regions() as usize];
    for ((MadeUpFrame { ideal, .. }, shown), denoised) in frames.iter().zip(shown).zip(denoised) {
        let mut differing = vec![0; runs.len()];
        let mut counted = vec![0; runs.len()];
        for (at, (&scene, &shown)) in denoised.iter().zip(shown).enumerate() {
            let at = u32::try_from(at).unwrap();
            let region = region(ideal_camera, at % ideal_camera.width(), at / ideal_camera.width());
            let difference = (scene - f64::from(shown)).abs();
            counted[region] += 1;
            differing[region] += u32::from(difference > f64::from(ideal_camera.temporal().level));
            if ideal.srs[region] {
                max = max.max(difference);
                sum += difference;
                relevant_pixels += 1.0;
            }
        }
        for (region, run) in runs.iter_mut().enumerate() {
            let needed = ideal_camera.temporal().min_count.max(1).min(counted[region]);
            let is_stale = ideal.srs[region] && differing[region] >= needed;
            relevant += f64::from(u8::from(ideal.srs[region]));
            stale += f64::from(u8::from(is_stale));
            *run = if is_stale { *run + 1 } else { 0 };
            longest = longest.max(*run);
        }
    }
    let mean = share(sum, relevant_pixels, 0.0);
    Staleness { max, mean, longest, share: share(stale, relevant, 0.0) }
}

fn check_scores(
    figures: &FidelityFigures,
    frames: &[MadeUpFrame],
    ideal_camera: &Camera,
    candidate_camera: &Camera,
) {
    if ideal_camera.region_size() != candidate_camera.region_size() {
        assert!(figures.scores.is_empty());
        return;
    }
    let n = f64::from(ideal_camera.region_pixels());
    let real = |score: u64| f64::from(u32::try_from(score).unwrap());
    let (mut edge, mut temporal) = (Vec::new(), Vec::new());
    for MadeUpFrame { ideal, candidate, .. } in frames {
        for region in 0..ideal.srs.len() {
            edge.push((ideal.scores[0][region] - real(candidate.scores[0][region])).abs() / n);
            let count = f64::from(candidate.temporal_count[region]);
            temporal.push((ideal.changed[region] - count).abs() / n);
        }
    }
    assert_eq!(figures.scores.len(), 2);
    for (error, (name, all)) in figures.scores.iter().zip([("edge", edge), ("temporal", temporal)])
    {
        assert_eq!(
            (error.feature.as_str(), error.unit.as_str()),
            (name, "share of the region's pixels")
        );
        let rms = mean(&all.iter().map(|error| error * error).collect::<Vec<_>>()).sqrt();
        let max = all.iter().copied().fold(0.0, f64::max);
        for (figure, expected) in [(error.max, max), (error.mean, mean(&all)), (error.rms, rms)] {
            assert!((figure - expected).abs() < 1e-9, "{name}: {figure} {expected}");
        }
    }
}

fn check(ideal_camera: &Camera, candidate_camera: &Camera, seed: u64, count: usize) {
    let mut random = RandomNumbers(seed);
    let frames: Vec<MadeUpFrame> =
        (0..count).map(|_| made_up(&mut random, ideal_camera, candidate_camera)).collect();
    let mut fidelity = Fidelity::new(ideal_camera, candidate_camera).unwrap();
    for (number, frame) in frames.iter().enumerate() {
        let input: ByteFrame = frame_from_words(ideal_camera, frame.input.clone());
        let shown = frame_from_words(candidate_camera, frame.screen.clone());
        let (outcome, screen) = (&frame.candidate, shown.borrowed_pixels());
        let candidate = CandidateFrame { outcome, screen, denoised: &frame.denoised };
        let order = if number == 0 { FrameOrder::First } else { FrameOrder::Later };
        fidelity.add(&input, &frame.ideal, candidate, order).unwrap();
    }
    let figures = fidelity.into_tally().figures();
    let depths = (candidate_camera.pixel_bits(), ideal_camera.pixel_bits());
    let shown = |frame: &MadeUpFrame| -> Vec<u16> {
        frame.screen.iter().map(|&pixel| convert_depth(pixel, depths.0, depths.1)).collect()
    };
    let shown: Vec<_> = frames.iter().map(shown).collect();
    check_decisions(&figures, &frames, ideal_camera, candidate_camera);
    check_staleness(&figures, &frames, &shown, (ideal_camera, candidate_camera));
    check_pictures(&figures, &frames, &shown, ideal_camera);
    check_scores(&figures, &frames, ideal_camera, candidate_camera);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn figures_equal_those_of_a_count_of_pixels(
        size in (1_u32..150, 1_u32..40),
        sides in (2_u32..20, 2_u32..20, any::<bool>()),
        bits in (prop_oneof![Just(8_u32), 1..=16_u32], prop_oneof![Just(8_u32), 1..=16_u32]),
        thresholds in (0_u32..3, 0_u32..5),
        seed in any::<u64>(),
        count in 1_usize..5,
    ) {
        let (ideal_side, candidate_side) = (sides.0, if sides.2 { sides.0 } else { sides.1 });
        let mut ideal = config(size, ideal_side, bits.0);
        let max = (1_u32 << bits.0) - 1;
        ideal.temporal.level = Some((max * thresholds.0 / 3).min(max - 1));
        ideal.temporal.min_count = (ideal_side * ideal_side * thresholds.1 / 6).min(ideal_side * ideal_side);
        let ideal = ideal.validate().unwrap();
        check(&ideal, &config(size, candidate_side, bits.1).validate().unwrap(), seed, count);
    }
}
