// SPDX-License-Identifier: MIT OR Apache-2.0
//! Several frames in one call give the results of single calls, for every camera, clip, division
//! into batches, number of threads and instruction set.

use foveate_camera::{Camera, FeatureKind, Neighborhood, ReferencePolicy, SpatialConfig};
use foveate_engine::{BatchScreens, Engine, EngineOptions, FrameOutcome, InstructionSet};
use foveate_model::FunctionalCamera;
use foveate_pixels::{Frame, FramePixels};
use proptest::prelude::*;

use crate::clip_script::{FrameChange, clip, scripts};
use crate::hard_cases::camera;
use crate::properties::assert_same;
use crate::random_cameras::cameras;

#[derive(Clone, Copy, Debug)]
struct EngineCall {
    frames: usize,
    /// Asks for the screens.
    screens: bool,
    reset: bool,
    /// Gives the frames one by one in spite of their number.
    single: bool,
}

fn calls() -> impl Strategy<Value = Vec<EngineCall>> {
    let call = (0usize..=7, any::<bool>(), proptest::bool::weighted(0.15), any::<bool>());
    let call = call.prop_map(|(frames, screens, reset, single)| EngineCall {
        frames,
        screens,
        reset,
        single: single && frames == 1,
    });
    proptest::collection::vec(call, 1..6)
}

/// Returns the rows of a frame with a gap between them, filled with values that no frame can have.
fn strided(camera: &Camera, frame: &Frame, gap: usize) -> Vec<u16> {
    let rows = frame.pixels().chunks(usize::try_from(camera.width()).unwrap());
    rows.flat_map(|row| row.iter().copied().chain(vec![u16::MAX; gap])).collect()
}

/// Screens of both widths, which all engines write in turn.
#[derive(Default)]
struct KeptScreens {
    bytes: BatchScreens<u8>,
    words: BatchScreens<u16>,
}

/// Returns the outcomes of frames that are given in one call, and their screens if `kept` is given.
fn step(
    engine: &mut Engine,
    frames: &[Frame],
    gap: usize,
    kept: Option<&mut KeptScreens>,
) -> (Vec<FrameOutcome>, Vec<Vec<u16>>) {
    let camera = engine.camera().clone();
    let stride = usize::try_from(camera.width()).unwrap() + gap;
    let words: Vec<Vec<u16>> = frames.iter().map(|f| strided(&camera, f, gap)).collect();
    if camera.pixel_bits() > 8 {
        let frames: Vec<&[u16]> = words.iter().map(Vec::as_slice).collect();
        let mut screens = kept.map(|kept| &mut kept.words);
        let outcomes = engine.step_batch_u16(&frames, stride, screens.as_deref_mut());
        let screens = screens.iter().flat_map(|screens| screens.iter());
        return (outcomes.unwrap().to_vec(), screens.map(<[u16]>::to_vec).collect());
    }
    let bytes = |words: &Vec<u16>| words.iter().map(|word| word.to_le_bytes()[0]).collect();
    let bytes: Vec<Vec<u8>> = words.iter().map(bytes).collect();
    let frames: Vec<&[u8]> = bytes.iter().map(Vec::as_slice).collect();
    let mut screens = kept.map(|kept| &mut kept.bytes);
    let outcomes = engine.step_batch_u8(&frames, stride, screens.as_deref_mut());
    let screens = screens.iter().flat_map(|screens| screens.iter());
    let screens = screens.map(|screen| FramePixels::Bytes(screen).to_words()).collect();
    (outcomes.unwrap().to_vec(), screens)
}

/// Runs a clip through the model frame by frame and through engines call by call. The clip is
/// repeated until the calls end. Returns how many regions one thread skipped.
fn check(
    camera: &Camera,
    clip: &[Frame],
    calls: &[EngineCall],
    options: EngineOptions,
    gap: usize,
) -> usize {
    let mut model = FunctionalCamera::new(camera);
    let engine =
        |threads| Engine::with_options(camera, EngineOptions { threads, ..options }).unwrap();
    let mut engines = [1, 2, 3].map(engine);
    let (mut clip, mut skipped, mut kept) = (clip.iter().cycle(), 0, KeptScreens::default());
    for call in calls {
        let context = format!("{call:?} of {calls:?}, {options:?}, {:?}", camera.config());
        if call.reset {
            model.reset();
            engines.iter_mut().for_each(Engine::reset);
        }
        let frames: Vec<Frame> = clip.by_ref().take(call.frames).cloned().collect();
        let expected: Vec<_> =
            frames.iter().map(|frame| model.step(frame).unwrap().clone()).collect();
        let results = engines.each_mut().map(|engine| match (call.single, &frames[..]) {
            (true, [frame]) => (vec![engine.step(frame).unwrap().clone()], Vec::new()),
            _ => step(engine, &frames, gap, call.screens.then_some(&mut kept)),
        });
        // The number of skipped regions does not depend on the number of threads either.
        assert_eq!(results[0], results[1], "two threads, {context}");
        assert_eq!(results[0], results[2], "three threads, {context}");
        let [(outcomes, screens), ..] = &results;
        assert_eq!(outcomes.len(), frames.len(), "{context}");
        let expects_screens = call.screens && !call.single;
        assert_eq!(screens.len(), if expects_screens { frames.len() } else { 0 }, "{context}");
        for (number, (actual, expected)) in outcomes.iter().zip(&expected).enumerate() {
            assert_same(actual, expected, &format!("frame {number} in {context}"));
            skipped += actual.skipped;
        }
        for (number, (screen, expected)) in screens.iter().zip(&expected).enumerate() {
            assert_eq!(screen, expected.rendered.pixels(), "screen {number} in {context}");
        }
        for engine in &engines {
            if let (Some(last), Some(expected)) = (outcomes.last(), expected.last()) {
                assert_eq!(engine.outcome(), last, "last outcome, {context}");
                let rendered = engine.rendered().to_words();
                assert_eq!(rendered, expected.rendered.pixels(), "last screen, {context}");
            }
        }
    }
    skipped
}

fn batch(frames: usize) -> EngineCall {
    EngineCall { frames, screens: true, reset: false, single: false }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(300)))]

    #[test]
    fn batches_equal_the_model(
        camera in cameras(),
        (seed, script) in scripts(),
        calls in calls(),
        skips_identical_regions in any::<bool>(),
        level in proptest::sample::select(InstructionSet::available()),
        gap in 0usize..4,
    ) {
        let options = EngineOptions { threads: 1, skips_identical_regions, level };
        check(&camera, &clip(&camera, seed, &script), &calls, options, gap);
    }
}

/// Frames that a batch divides among threads, still and moving, in batches of every length.
#[test]
fn strips_of_a_batch_equal_the_model() {
    use FrameChange::{Noise, Patch, Spot, Still};
    let script =
        [Still, Still, Patch(0.4, 0.2), Still, Still, Noise, Still, Spot(0.5, 0.5), Still, Still];
    // These four cases contain every pair of values.
    let cameras = [
        (Neighborhood::Isolated, ReferencePolicy::Previous, 8),
        (Neighborhood::Isolated, ReferencePolicy::LastSent, 10),
        (Neighborhood::Shared, ReferencePolicy::Previous, 10),
        (Neighborhood::Shared, ReferencePolicy::LastSent, 8),
    ];
    for side in [5, 8, 32] {
        for (neighborhood, reference, bits) in cameras {
            let camera = camera(330, 170, side, |config| {
                config.spatial =
                    FeatureKind::ALL.iter().map(|&kind| SpatialConfig::new(kind)).collect();
                config.frame.pixel_bits = bits;
                config.region.neighborhood = neighborhood;
                config.temporal.reference = reference;
            });
            let calls = [batch(2), batch(5), batch(1), batch(9), batch(4)];
            let clip = clip(&camera, 9, &script);
            assert!(check(&camera, &clip, &calls, EngineOptions::default(), 0) > 0);
        }
    }
}

/// A still clip is found within a batch, without a batch before it.
#[test]
fn still_frames_of_a_single_batch_are_skipped() {
    let camera = camera(250, 70, 8, |_| {});
    let frames = clip(&camera, 5, &[FrameChange::Still; 7]);
    let skipped = check(&camera, &frames, &[batch(8)], EngineOptions::default(), 0);
    assert_eq!(skipped, 7 * usize::try_from(camera.regions()).unwrap());
}

/// The batches have more frames than go through the engine together.
#[test]
fn long_batches_equal_the_model() {
    let camera = camera(1500, 1100, 64, |_| {});
    let script =
        [FrameChange::Still, FrameChange::Patch(0.3, 0.4), FrameChange::Still, FrameChange::Fade];
    let calls = [batch(7), batch(6)];
    check(&camera, &clip(&camera, 11, &script), &calls, EngineOptions::default(), 0);
}
