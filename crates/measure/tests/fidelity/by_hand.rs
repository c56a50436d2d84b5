// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cameras on scenes, the sums of tallies, the units of scores, and refused results.

use std::collections::BTreeMap;

use foveate_camera::{
    Camera, CameraConfig, Decimal, DenoiseFilter, Displacement, FeatureKind, Neighborhood,
    SpatialConfig,
};
use foveate_engine::Engine;
use foveate_measure::{CandidateFrame, ErrorTally, Fidelity, FidelityError, FrameOrder};
use foveate_pixels::{ByteFrame, FramePixels, Scene, SceneParameters};

use crate::results::{blank_ideal, blank_outcome, config, frame_from_words, pixels, run, tally};

/// The score of `flow` is rounded down to a whole number of 64ths of a grey level in regions of 8x8
/// pixels, because a displaced reference is compared with fewer pixels.
const ROUNDING: f64 = 1.0 / 64.0;

fn scene(scene: Scene, camera: &Camera, frames: u32) -> Vec<ByteFrame> {
    let (width, height, bits) = (camera.width(), camera.height(), camera.pixel_bits());
    let size = SceneParameters { width, height, bits, region_size: camera.region_size(), frames };
    scene.frames(size).map(|frame| ByteFrame::from(&frame)).collect()
}

/// Returns a configuration with all features, windows over the whole frame, and an exact mean.
fn exact() -> CameraConfig {
    let mut config = config((90, 45), 8, 8);
    config.region.neighborhood = Neighborhood::Shared;
    config.spatial = FeatureKind::ALL.iter().map(|&kind| SpatialConfig::new(kind)).collect();
    set_fraction_bits(&mut config, 6);
    config
}

/// Sets the fraction bits of the mean that `mad` and `segment` share.
fn set_fraction_bits(config: &mut CameraConfig, bits: u32) {
    for entry in config.spatial.iter_mut().filter(|entry| entry.has_mean_fraction()) {
        entry.mean_fraction_bits = Some(bits);
    }
}

#[test]
fn the_engine_of_the_same_design_is_the_ideal() {
    let camera = exact().validate().unwrap();
    let figures = tally(&camera, &camera, &scene(Scene::Street, &camera, 12)).figures();
    assert_eq!(figures.frames, 12);
    assert_eq!([figures.srs_flips, figures.trs_flips, figures.action_flips], [0.0; 3]);
    assert_eq!([figures.missed, figures.false_alarms, figures.active_iou], [0.0, 0.0, 1.0]);
    assert!(figures.active > 0.0 && figures.active == figures.ideal_active);
    assert_eq!((figures.psnr_ideal, figures.ssim_ideal), (None, 1.0));
    let names: Vec<&str> = figures.scores.iter().map(|score| score.feature.as_str()).collect();
    assert_eq!(names, [FeatureKind::NAMES, &["temporal"]].concat());
    for score in &figures.scores {
        if score.feature == "flow" {
            assert!(score.max > 0.0 && score.max < ROUNDING, "{}", score.max);
        } else {
            assert_eq!((score.max, score.mean, score.rms), (0.0, 0.0, 0.0), "{}", score.feature);
        }
    }
}

/// The errors of isolated windows and of a mean without fraction bits appear in their own scores,
/// and nowhere else.
#[test]
fn a_cheaper_candidate_differs_where_it_is_cheaper() {
    let ideal = exact();
    let mut candidate = ideal.clone();
    set_fraction_bits(&mut candidate, 0);
    let [ideal, rounded] = [ideal, candidate.clone()].map(|config| config.validate().unwrap());
    candidate.region.neighborhood = Neighborhood::Isolated;
    let isolated = candidate.validate().unwrap();
    let frames = scene(Scene::NightRain, &ideal, 4);
    let errors = |candidate: &Camera| -> BTreeMap<String, f64> {
        let scores = tally(&ideal, candidate, &frames).figures().scores;
        scores.into_iter().map(|score| (score.feature, score.max)).collect()
    };
    for (feature, error) in errors(&rounded) {
        match feature.as_str() {
            "mad" => assert!(error > 0.0 && error <= 0.5, "half a quantum of the mean: {error}"),
            "segment" => assert!(error > 0.0, "some pixels change their side"),
            "flow" => assert!(error < ROUNDING, "{error}"),
            _ => assert_eq!(error, 0.0, "{feature}"),
        }
    }
    let isolated = errors(&isolated);
    assert!(isolated["edge"] > 0.0 && isolated["surface"] > 0.0);
}

#[test]
fn tallies_add_up_in_any_order() {
    let ideal = exact().validate().unwrap();
    let candidate = config((90, 45), 5, 6).validate().unwrap();
    let clips = [Scene::Street, Scene::NightRain, Scene::Shake].map(|clip| {
        let frames = |camera| scene(clip, camera, 5);
        frames(&ideal).into_iter().zip(frames(&candidate)).collect::<Vec<_>>()
    });
    let mut whole = Fidelity::new(&ideal, &candidate).unwrap();
    let mut parts = Vec::new();
    for clip in &clips {
        run(&ideal, &candidate, clip, &mut whole);
        whole.next_clip();
        let mut part = Fidelity::new(&ideal, &candidate).unwrap();
        run(&ideal, &candidate, clip, &mut part);
        parts.push(part.into_tally());
    }
    for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
        let mut merged = ErrorTally::default();
        order.iter().for_each(|&at: &usize| merged.merge(&parts[at]));
        assert_eq!(&merged, whole.tally());
        assert_eq!(merged.figures(), whole.tally().figures());
    }
    assert_eq!(whole.tally().figures().frames, 15);
    assert!(whole.tally().figures().scores.is_empty(), "regions of other sizes");
    let stored = serde_json::to_string(whole.tally()).unwrap();
    assert_eq!(&serde_json::from_str::<ErrorTally>(&stored).unwrap(), whole.tally());
}

#[test]
fn a_tally_without_frames_has_no_errors() {
    let figures = ErrorTally::default().figures();
    assert_eq!((figures.frames, figures.srs_flips, figures.missed), (0, 0.0, 0.0));
    assert_eq!((figures.active_iou, figures.ssim_ideal, figures.psnr_ideal), (1.0, 1.0, None));
}

/// With 6 bits in place of 8, a grey level of the candidate is four levels of the ideal, and a
/// squared level is sixteen.
#[test]
fn scores_of_fewer_bits_are_scaled_up() {
    let mut ideal_camera = config((2, 2), 2, 8);
    ideal_camera.spatial =
        [FeatureKind::Variance, FeatureKind::Mad].map(SpatialConfig::new).to_vec();
    let mut candidate_camera = config((2, 2), 2, 6);
    candidate_camera.spatial = [FeatureKind::Mad, FeatureKind::Edge, FeatureKind::Variance]
        .map(SpatialConfig::new)
        .to_vec();
    candidate_camera.spatial[0].mean_fraction_bits = Some(1);
    candidate_camera.spatial[1].min_score = Some(Decimal::from_whole(1));
    let [ideal_camera, candidate_camera] =
        [ideal_camera, candidate_camera].map(|config| config.validate().unwrap());
    let (mut ideal, mut candidate) = (blank_ideal(&ideal_camera), blank_outcome(&candidate_camera));
    // The score 24 / (4 * 2) = 3 grey levels of 6 bits is 12 levels of 8 bits; 80 / 16 = 5 squared
    // levels are 80.
    (ideal.scores[1][0], candidate.scores[0][0]) = (12.5, 24);
    (ideal.scores[0][0], candidate.scores[2][0]) = (82.0, 80);
    let mut fidelity = Fidelity::new(&ideal_camera, &candidate_camera).unwrap();
    let input = frame_from_words(&ideal_camera, vec![0; 4]);
    let candidate = CandidateFrame {
        outcome: &candidate,
        screen: FramePixels::Bytes(&[0; 4]),
        denoised: &[0; 4],
    };
    fidelity.add(&input, &ideal, candidate, FrameOrder::Later).unwrap();
    let figures = fidelity.tally().figures();
    let observed = figures.scores.iter().map(|score| (&*score.feature, &*score.unit, score.max));
    let expected = [
        ("variance", "squared grey levels", 2.0),
        ("mad", "grey levels", 0.5),
        ("temporal", "share of the region's pixels", 0.0),
    ];
    assert_eq!(observed.collect::<Vec<_>>(), expected);
}

/// A bar moves by a column, and a pixel changes: E(0) is 1290 over 64 pixels, and E(1, 0) is 10
/// over
/// 56. The score is 1290/64 - 10/56 grey levels, 1278 + 4/7 64ths, and is rounded down to 1278/64.
#[test]
fn the_gain_of_a_displacement_is_rounded_down() {
    let mut camera = config((8, 8), 8, 8);
    camera.spatial = vec![SpatialConfig::new(FeatureKind::Flow)];
    camera.denoise.filter = DenoiseFilter::None;
    let camera = camera.validate().unwrap();
    let bar = |column: u16| -> Vec<u16> {
        (0..64).map(|at| if at % 8 == column { 80 } else { 0 }).collect()
    };
    let mut moved = bar(3);
    moved[4 * 8 + 5] = 10;
    let frames = [bar(2), moved].map(|pixels| frame_from_words(&camera, pixels));
    let mut engine = Engine::new(&camera);
    for frame in &frames {
        engine.step_byte_frame(frame).unwrap();
    }
    assert_eq!(engine.outcome().scores, [[1278]]);
    assert_eq!(engine.outcome().displacements, [Displacement { dx: 1, dy: 0 }]);
    let figures = tally(&camera, &camera, &frames).figures();
    let score = &figures.scores[0];
    assert_eq!((&*score.feature, &*score.unit), ("flow", "grey levels"));
    let error = 4.0 / 7.0 / 64.0;
    assert!((score.max - error).abs() < 1e-12, "{}", score.max);
    assert!((score.mean - error / 2.0).abs() < 1e-12, "the first frame has no error");
    assert_eq!(figures.srs_flips, 0.0);
}

#[test]
fn sizes_types_and_lengths_that_do_not_match_are_refused() {
    let camera = config((16, 8), 8, 8).validate().unwrap();
    let other = config((16, 9), 8, 8).validate().unwrap();
    let text = Fidelity::new(&camera, &other).unwrap_err().to_string();
    assert!(text.contains("16x8") && text.contains("16x9"), "{text}");

    let mut fidelity = Fidelity::new(&camera, &camera).unwrap();
    let (ideal, candidate) = (blank_ideal(&camera), blank_outcome(&camera));
    let (input, black) = (frame_from_words(&camera, vec![0; pixels(&camera)]), vec![0_u8; 128]);
    let denoised = vec![0_u16; 128];
    let results = |screen| CandidateFrame { outcome: &candidate, screen, denoised: &denoised };
    let mut refused = |input: &ByteFrame, screen: FramePixels<'_>| {
        let candidate = CandidateFrame { outcome: &candidate, screen, denoised: &denoised };
        fidelity.add(input, &ideal, candidate, FrameOrder::Later).unwrap_err()
    };
    let tall = frame_from_words(&other, vec![0; 144]);
    assert!(matches!(
        refused(&tall, FramePixels::Bytes(&black)),
        FidelityError::FrameFormat { .. }
    ));
    assert!(matches!(
        refused(&input, FramePixels::Words(&[0; 128])),
        FidelityError::PixelType { .. }
    ));
    let short = refused(&input, FramePixels::Bytes(&black[1..]));
    assert!(matches!(short, FidelityError::ResultLength { given: 127, expected: 128, .. }));
    let mut less = candidate.clone();
    less.scores[0].pop();
    let screen = FramePixels::Bytes(&black);
    let less = CandidateFrame { outcome: &less, ..results(screen) };
    let error = fidelity.add(&input, &ideal, less, FrameOrder::Later).unwrap_err();
    assert_eq!(
        error,
        FidelityError::ResultLength { what: "candidate, scores", given: 1, expected: 2 }
    );
    assert_eq!(fidelity.tally().frames(), 0);
    let whole = results(screen);
    let short = CandidateFrame { denoised: &denoised[1..], ..whole };
    let error = fidelity.add(&input, &ideal, short, FrameOrder::Later).unwrap_err();
    assert!(error.to_string().contains("denoised"), "{error}");
    fidelity.add(&input, &ideal, whole, FrameOrder::Later).unwrap();
}
