// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of all minima against cameras that have these minima.

use foveate_camera::{
    CameraConfig, Decimal, FeatureKind, IrrelevantRendering, SpatialConfig, VoteCombination,
};
use foveate_engine::Engine;
use foveate_ideal::IdealCamera;
use foveate_measure::{
    CandidateFrame, DecisionAreas, DecisionLimits, DecisionState, Fidelity, FrameOrder,
    MinimumSteps, ThresholdTable,
};
use foveate_pixels::{ByteFrame, Scene, SceneParameters};

use crate::results::config;

const FRAMES: u32 = 6;
const GROUPS: usize = 2;
const SIZE: (u32, u32) = (90, 45);

fn frames(bits: u32) -> Vec<ByteFrame> {
    let (width, height) = SIZE;
    let size = SceneParameters { width, height, bits, region_size: 8, frames: FRAMES };
    Scene::Street.frames(size).map(|frame| ByteFrame::from(&frame)).collect()
}

/// Shows the street to the ideal camera and to a candidate, frame by frame.
fn run(
    ideal: &CameraConfig,
    candidate: &CameraConfig,
    mut see: impl FnMut(&IdealCamera, &Engine, usize),
) {
    let mut camera = IdealCamera::new(&ideal.validate().unwrap());
    let mut engine = Engine::new(&candidate.validate().unwrap());
    let pairs = frames(ideal.frame.pixel_bits).into_iter().zip(frames(candidate.frame.pixel_bits));
    for (number, (own, other)) in pairs.enumerate() {
        camera.step(&own).unwrap();
        engine.step_byte_frame(&other).unwrap();
        see(&camera, &engine, number);
    }
}

fn order(number: usize) -> FrameOrder {
    if number == 0 { FrameOrder::First } else { FrameOrder::Later }
}

/// Returns the areas of a candidate's decisions in every group of frames.
fn measured(ideal: &CameraConfig, candidate: &CameraConfig) -> Vec<DecisionAreas> {
    let cameras = (ideal.validate().unwrap(), candidate.validate().unwrap());
    let mut fidelity = Fidelity::new(&cameras.0, &cameras.1).unwrap();
    let inputs = frames(ideal.frame.pixel_bits);
    let denoised = vec![0; (SIZE.0 * SIZE.1) as usize];
    let mut groups = vec![DecisionAreas::default(); GROUPS];
    run(ideal, candidate, |camera, engine, number| {
        let (outcome, screen) = (engine.outcome(), engine.rendered());
        let frame = CandidateFrame { outcome, screen, denoised: &denoised };
        let areas = fidelity.add(&inputs[number], camera.outcome(), frame, order(number)).unwrap();
        groups[number % GROUPS].add(&areas);
    });
    groups
}

fn table(ideal: &CameraConfig, candidate: &CameraConfig, steps: MinimumSteps) -> ThresholdTable {
    let cameras = (ideal.validate().unwrap(), candidate.validate().unwrap());
    let mut table = ThresholdTable::new(&cameras.0, &cameras.1, steps, GROUPS);
    run(ideal, candidate, |camera, engine, number| {
        let outcome = camera.outcome();
        let state =
            |at: usize| DecisionState::new(outcome.srs[at], outcome.trs[at], outcome.actions[at]);
        let states: Vec<_> = (0..outcome.srs.len()).map(state).collect();
        table.add_frame(&states, engine.outcome(), (order(number), number % GROUPS));
    });
    table
}

fn candidate(side: u32, bits: u32, kinds: &[FeatureKind]) -> CameraConfig {
    let mut candidate = config(SIZE, side, bits);
    candidate.spatial = kinds.iter().map(|&kind| SpatialConfig::new(kind)).collect();
    candidate.validate().unwrap().config().clone()
}

/// Counts and scores with which some regions are relevant.
const COUNTS: [u32; 4] = [1, 3, 9, 20];

#[test]
fn decisions_are_those_of_cameras_with_these_minima() {
    let ideal = config(SIZE, 8, 8);
    let kinds = [FeatureKind::Edge, FeatureKind::Mad];
    let renderings = [IrrelevantRendering::Zero, IrrelevantRendering::Hold];
    for (side, bits, kinds) in [(8, 8, &kinds[..]), (5, 6, &kinds[1..]), (8, 4, &kinds[..1])] {
        for (combine, irrelevant) in
            [VoteCombination::Any, VoteCombination::All].into_iter().zip(renderings)
        {
            let mut candidate = candidate(side, bits, kinds);
            candidate.decision.combine = combine;
            candidate.render.irrelevant = irrelevant;
            assert!(ThresholdTable::has_free_scores(&candidate));
            let scores = |kind: &FeatureKind| {
                if kind.score_unit().is_count() { vec![1, 2, 8] } else { vec![1, 40, 300] }
            };
            let steps = MinimumSteps {
                counts: COUNTS.to_vec(),
                scores: kinds.iter().map(scores).collect(),
            };
            let table = table(&ideal, &candidate, steps.clone());
            for chosen in [[0, 0, 0], [1, 2, 1], [3, 1, 2], [2, 2, 0]] {
                let chosen = chosen[..=kinds.len()].to_vec();
                candidate.temporal.min_count = COUNTS[chosen[0]];
                let features = candidate.validate().unwrap().features().to_vec();
                for (number, feature) in features.iter().enumerate() {
                    let score = steps.scores[number][chosen[1 + number]];
                    let billionths = (score * 1_000_000_000).div_euclid(feature.unit());
                    candidate.spatial[number].min_score =
                        Some(Decimal::from_billionths(billionths));
                }
                let set: Vec<_> = candidate
                    .validate()
                    .unwrap()
                    .features()
                    .iter()
                    .map(|f| f.min_score())
                    .collect();
                let wanted: Vec<_> =
                    (0..kinds.len()).map(|at| steps.scores[at][chosen[1 + at]]).collect();
                assert_eq!(set, wanted);
                let found = table.decisions(&chosen);
                assert_eq!(found, measured(&ideal, &candidate), "{kinds:?} {chosen:?}");
                assert!(found.iter().any(|group| group.action > 0), "it would show nothing");
            }
        }
    }
}

#[test]
fn the_nearest_minima_of_one_feature_are_the_best_of_all() {
    let ideal = config(SIZE, 8, 8);
    let steps = MinimumSteps { counts: COUNTS.to_vec(), scores: vec![vec![1, 2, 5, 8, 13]] };
    let table = table(&ideal, &candidate(8, 4, &[FeatureKind::Edge]), steps);
    let limits = DecisionLimits {
        flips: Some(0.02),
        missed: Some(0.1),
        false_alarms: Some(0.1),
        prefers_active_below: None,
    };
    let (found, compared) = table.nearest(vec![3, 0], &limits, 3);
    assert_eq!((found.len(), compared), (3, 1 + 4 * 5));
    let mut least_flips = u64::MAX;
    let all = (0..4).flat_map(|count| (0..5).map(move |score| vec![count, score]));
    let mut distances: Vec<f64> = all
        .map(|chosen| {
            let mut sum = DecisionAreas::default();
            table.decisions(&chosen).iter().for_each(|group| sum.add(group));
            least_flips = least_flips.min(sum.action);
            limits.distance([sum.flips(), sum.missed(), sum.false_alarms()], 0.0)
        })
        .collect();
    distances.sort_by(f64::total_cmp);
    let found: Vec<f64> = found.iter().map(|minima| minima.distance).collect();
    assert_eq!(found, distances[..3]);
    assert_eq!(table.least_flips(), least_flips);
}

#[test]
fn a_limit_of_nothing_is_far_from_every_rate_but_nothing() {
    let limits = DecisionLimits {
        flips: Some(0.0),
        missed: Some(0.1),
        false_alarms: None,
        prefers_active_below: None,
    };
    assert_eq!(limits.distance([0.0, 0.05, 0.9], 0.2), 0.5);
    assert!(limits.distance([1e-9, 0.0, 0.0], 0.2) > 1.0);
}

/// Well within the limits, minima that send more are nearer; elsewhere the limits decide.
#[test]
fn the_nearest_minima_may_be_those_that_send_most() {
    let ideal = config(SIZE, 8, 8);
    let steps = MinimumSteps { counts: COUNTS.to_vec(), scores: vec![vec![1, 2, 5, 8, 13]] };
    let table = table(&ideal, &candidate(8, 4, &[FeatureKind::Edge]), steps);
    let limits = DecisionLimits {
        flips: Some(0.5),
        prefers_active_below: Some(0.8),
        ..DecisionLimits::default()
    };
    let (found, _) = table.nearest(vec![3, 0], &limits, 20);
    let figures = found.iter().map(|minima| {
        let mut sum = DecisionAreas::default();
        table.decisions(&minima.chosen).iter().for_each(|group| sum.add(group));
        (sum.flips() <= 0.4, sum.later.candidate)
    });
    let figures: Vec<(bool, u64)> = figures.collect();
    let within = figures.iter().take_while(|(is_within, _)| *is_within).count();
    assert!(figures[within..].iter().all(|(is_within, _)| !is_within), "{figures:?}");
    assert!(within > 5 && figures[..within].is_sorted_by(|one, other| one.1 >= other.1));
    assert!(figures[0].1 > figures[within - 1].1, "{figures:?}");
}
