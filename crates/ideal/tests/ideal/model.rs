// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ideal camera against the functional model: they agree wherever the model does not round.
#![allow(clippy::cast_precision_loss, reason = "scores are below 2^53, or compared within 1e-12")]

use crate::generators;
use crate::generators::{ChangeScript, FrameChange, cameras, script_frames};
use foveate_camera::{
    Camera, CameraConfig, Decimal, DenoiseFilter, FeatureKind, Neighborhood, RegionClass,
    SpatialConfig,
};
use foveate_ideal::{IdealCamera, IdealOutcome};
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_pixels::{ByteFrame, Frame};
use proptest::prelude::*;

/// Converts a score of the model to the unit of the ideal camera.
fn score_in_ideal_unit(camera: &Camera, feature: usize, score: u64) -> f64 {
    score as f64 / camera.features()[feature].unit() as f64
}

fn crop(camera: &Camera, padded: &Frame) -> Vec<f64> {
    let positions = (0..camera.height()).flat_map(|y| (0..camera.width()).map(move |x| (x, y)));
    positions.map(|(x, y)| f64::from(padded.get(x, y))).collect()
}

fn assert_decisions(
    ideal: &IdealOutcome,
    model: &FunctionalOutcome,
    camera: &Camera,
    context: &str,
) {
    assert_eq!(ideal.srs, model.srs, "srs, {context}");
    assert_eq!(ideal.trs, model.trs, "trs, {context}");
    assert_eq!(ideal.active, model.active, "active, {context}");
    assert_eq!(ideal.actions, model.actions, "actions, {context}");
    let changed: Vec<f64> = model.temporal_count.iter().map(|&count| count.into()).collect();
    assert_eq!(ideal.changed, changed, "changed, {context}");
    assert_eq!(ideal.denoised, crop(camera, &model.denoised), "denoised, {context}");
    assert_eq!(ideal.rendered, crop(camera, &model.rendered), "rendered, {context}");
}

fn check_exact(camera: &Camera, frames: &[Frame]) {
    check_exact_with_maps(camera, frames, &[]);
}

/// Compares both cameras on a clip, with a map for each frame, or without maps.
fn check_exact_with_maps(camera: &Camera, frames: &[Frame], maps: &[Vec<RegionClass>]) {
    let mut ideal = IdealCamera::new(camera);
    let mut model = FunctionalCamera::new(camera);
    for round in 0..2 {
        for (number, frame) in frames.iter().enumerate() {
            let context = format!("round {round}, frame {number}, {:?}", camera.config());
            if let Some(map) = maps.get(number) {
                model.set_classes(map).unwrap();
                ideal.set_classes(map).unwrap();
            }
            let model = model.step(frame).unwrap();
            let ideal = ideal.step(&ByteFrame::from(frame)).unwrap();
            assert_decisions(ideal, model, camera, &context);
            for (feature, (own, other)) in ideal.scores.iter().zip(&model.scores).enumerate() {
                for (&own, &score) in own.iter().zip(other) {
                    let expected = score_in_ideal_unit(camera, feature, score);
                    // Above 2^53 the ideal camera itself has to round.
                    let near = score >= 1 << 53 && (own - expected).abs() <= expected * 1e-12;
                    assert!(own == expected || near, "{own} for {expected}, {context}");
                }
            }
        }
        // A reset forgets every frame.
        ideal.reset();
        model.reset();
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Nothing rounds with shared windows, sides that are powers of two, and a mean of log2 n
    /// fraction bits. Without `mad` nothing rounds for any side.
    #[test]
    fn it_equals_the_model_where_nothing_is_rounded(
        (camera, seed, script) in cameras(false).prop_flat_map(with_script),
    ) {
        check_exact(&camera, &script_frames(&camera, seed, &script));
    }

    #[test]
    fn zones_equal_those_of_the_model(
        (camera, seed, script) in generators::zoned_cameras().prop_flat_map(with_script),
    ) {
        let frames = script_frames(&camera, seed, &script);
        check_exact_with_maps(&camera, &frames, &generators::maps(&camera, frames.len(), seed));
    }

    /// The model's mean is `floor(v + h)` quanta of 2^-f for the real mean v, a multiple of 1/n,
    /// with h = floor(n/2)/n. So it is off by at most h quanta. A mean that is off by e moves every
    /// |x - mean|, and with them their mean, by at most e.
    #[test]
    fn mad_is_off_by_no_more_than_its_mean(
        (camera, seed, script) in cameras(true).prop_flat_map(with_script),
    ) {
        let mut ideal = IdealCamera::new(&camera);
        let mut model = FunctionalCamera::new(&camera);
        for frame in script_frames(&camera, seed, &script) {
            let model = model.step(&frame).unwrap();
            let ideal = ideal.step(&ByteFrame::from(&frame)).unwrap();
            for (feature, kind) in camera.features().iter().enumerate() {
                let FeatureKind::Mad = kind.kind() else { continue };
                let mean = kind.mean().unwrap();
                let n = camera.region_pixels();
                let quantum = 1.0 / f64::from(1_u32 << mean.fraction_bits);
                let bound = f64::from(n / 2) / f64::from(n) * quantum;
                for (&ideal_score, &score) in ideal.scores[feature].iter().zip(&model.scores[feature]) {
                    let model_score = score_in_ideal_unit(&camera, feature, score);
                    prop_assert!((ideal_score - model_score).abs() <= bound * (1.0 + 1e-9), "{ideal_score} {model_score}");
                }
            }
        }
    }
}

/// A pattern that moves by known steps: the score of the model is rounded down to a multiple of
/// 1/n.
#[test]
fn the_score_of_flow_is_rounded_down() {
    let mut votes = 0;
    for (side, radius, bits) in [(8, 3, 8), (5, 2, 12), (2, 1, 8), (7, 3, 1)] {
        let mut config = CameraConfig::default();
        (config.frame.width, config.frame.height) = (Some(3 * side), Some(2 * side - 1));
        (config.region.size, config.frame.pixel_bits) = (side, bits);
        config.denoise.filter = DenoiseFilter::None;
        config.spatial = vec![SpatialConfig::new(FeatureKind::Flow)];
        config.spatial[0].radius = Some(radius);
        config.spatial[0].min_score = Decimal::from_f64(0.1);
        config.temporal.min_count = 1;
        let camera = config.validate().unwrap();
        let (mut ideal, mut model) = (IdealCamera::new(&camera), FunctionalCamera::new(&camera));
        let changes = [FrameChange::Noise, FrameChange::Patch(3, 5), FrameChange::Binary];
        let mut frames = script_frames(&camera, 3, &changes);
        for (dx, dy) in [(1, 0), (-1, 2), (3, -3)] {
            let last = frames.last().unwrap().clone();
            let moved = |x: u32, y: u32| last.get_clamped(i64::from(x) - dx, i64::from(y) - dy);
            frames.push(Frame::from_fn(camera.width(), camera.height(), bits, moved).unwrap());
        }
        for frame in frames {
            let ideal = &ideal.step(&ByteFrame::from(&frame)).unwrap().scores[0];
            let model = &model.step(&frame).unwrap().scores[0];
            for (&ideal, &score) in ideal.iter().zip(model) {
                let units = ideal * f64::from(camera.region_pixels());
                assert!(
                    (0.0..1.0 + 1e-9).contains(&(units + 1e-9 - score as f64)),
                    "{units} {score}"
                );
                votes += u32::from(score > 0);
            }
        }
    }
    assert!(votes > 50, "{votes}");
}

/// The model rounds each pixel of `binomial3x3` to the nearest integer, halves up.
#[test]
fn the_pixels_of_the_binomial_filter_are_those_of_the_model_before_rounding() {
    for (width, height, side, bits) in [(9, 7, 4, 8), (16, 16, 8, 12), (5, 5, 2, 1)] {
        let mut config = CameraConfig::default();
        (config.frame.width, config.frame.height) = (Some(width), Some(height));
        (config.region.size, config.frame.pixel_bits) = (side, bits);
        config.region.neighborhood = Neighborhood::Shared;
        config.denoise.filter = DenoiseFilter::Binomial3x3;
        config.temporal.min_count = 1;
        config.spatial[0].min_score = Some(Decimal::from_whole(1));
        let camera = config.validate().unwrap();
        let (mut ideal, mut model) = (IdealCamera::new(&camera), FunctionalCamera::new(&camera));
        for frame in script_frames(&camera, 3, &[FrameChange::Noise, FrameChange::Binary]) {
            let ideal = ideal.step(&ByteFrame::from(&frame)).unwrap();
            let model = crop(&camera, &model.step(&frame).unwrap().denoised);
            let rounded: Vec<f64> = ideal.denoised.iter().map(|x| (x + 0.5).floor()).collect();
            assert_eq!(rounded, model);
        }
    }
}

fn with_script(camera: Camera) -> impl Strategy<Value = (Camera, u64, ChangeScript)> {
    (Just(camera), any::<u64>(), generators::scripts())
}
