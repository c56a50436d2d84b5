// SPDX-License-Identifier: MIT OR Apache-2.0
//! Property tests: engine and model give the same results for every camera, clip, instruction set
//! and number of threads, with and without skipping.

use foveate_camera::Camera;
use foveate_engine::{Engine, EngineOptions, FrameOutcome, InstructionSet};
use foveate_model::FunctionalCamera;
use foveate_pixels::{Frame, FramePixels};
use proptest::prelude::*;

use crate::clip_script::{clip, scripts};
use crate::random_cameras::cameras;

pub(crate) fn assert_same(
    actual: &FrameOutcome,
    expected: &foveate_model::FunctionalOutcome,
    context: &str,
) {
    assert_eq!(actual.scores, expected.scores, "scores, {context}");
    assert_eq!(actual.displacements, expected.displacements, "displacements, {context}");
    assert_eq!(actual.temporal_count, expected.temporal_count, "temporal count, {context}");
    assert_eq!(actual.srs, expected.srs, "srs, {context}");
    assert_eq!(actual.trs, expected.trs, "trs, {context}");
    assert_eq!(actual.active, expected.active, "active, {context}");
    assert_eq!(actual.actions, expected.actions, "actions, {context}");
}

/// Runs a clip through the model and the engine. Returns how many regions were skipped.
pub(crate) fn check(camera: &Camera, frames: &[Frame], options: EngineOptions) -> usize {
    check_all(camera, frames, [options])[0]
}

/// Runs a clip through the model and one engine for each of the options. Returns how many regions
/// each engine skipped.
pub(crate) fn check_all<const N: usize>(
    camera: &Camera,
    frames: &[Frame],
    option_sets: [EngineOptions; N],
) -> [usize; N] {
    let mut model = FunctionalCamera::new(camera);
    let mut engines = option_sets.map(|options| Engine::with_options(camera, options).unwrap());
    let mut skipped = [0; N];
    for (number, frame) in frames.iter().enumerate() {
        let expected = model.step(frame).unwrap();
        for ((engine, options), skipped) in engines.iter_mut().zip(option_sets).zip(&mut skipped) {
            let context = format!("frame {number}, {options:?}, {:?}", camera.config());
            let actual = engine.step(frame).unwrap();
            assert_same(actual, expected, &context);
            *skipped += actual.skipped;
            assert_eq!(
                engine.rendered().to_words(),
                expected.rendered.pixels(),
                "screen, {context}"
            );
        }
    }
    // After a reset, both give the same results again.
    model.reset();
    if let Some(frame) = frames.last() {
        let expected = model.step(frame).unwrap();
        for engine in &mut engines {
            engine.reset();
            assert_same(engine.step(frame).unwrap(), expected, "after a reset");
        }
    }
    skipped
}

fn options() -> impl Strategy<Value = EngineOptions> {
    let level = proptest::sample::select(InstructionSet::available());
    (1usize..=2, any::<bool>(), level).prop_map(|(threads, skip, level)| EngineOptions {
        threads,
        skips_identical_regions: skip,
        level,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(400)))]

    #[test]
    fn engine_equals_the_model(
        camera in cameras(),
        (seed, script) in scripts(),
        options in options(),
    ) {
        check(&camera, &clip(&camera, seed, &script), options);
    }

    /// A frame with a stride gives the same results as a copy without one.
    #[test]
    fn rows_with_a_stride_equal_a_whole_frame(
        camera in cameras(),
        (seed, script) in scripts(),
        gap in 0usize..5,
    ) {
        let (mut plain, mut strided) = (Engine::new(&camera), Engine::new(&camera));
        let width = usize::try_from(camera.width()).unwrap();
        for frame in clip(&camera, seed, &script) {
            let rows = frame.pixels().chunks(width);
            let words: Vec<u16> =
                rows.flat_map(|row| row.iter().copied().chain(vec![u16::MAX; gap])).collect();
            let expected = plain.step(&frame).unwrap();
            match has_byte_pixels(&camera) {
                true => {
                    let bytes: Vec<u8> = words.iter().map(|&p| p.to_le_bytes()[0]).collect();
                    prop_assert_eq!(strided.step_u8(&bytes, width + gap).unwrap(), expected);
                }
                false => prop_assert_eq!(strided.step_u16(&words, width + gap).unwrap(), expected),
            }
            prop_assert_eq!(strided.rendered(), plain.rendered());
            let bytes = matches!(plain.rendered(), FramePixels::Bytes(_));
            prop_assert_eq!(bytes, has_byte_pixels(&camera));
        }
    }
}

fn has_byte_pixels(camera: &Camera) -> bool {
    camera.pixel_bits() <= 8
}
