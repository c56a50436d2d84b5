// SPDX-License-Identifier: MIT OR Apache-2.0
//! Zones: engine and model give the same results while the map changes between frames, also between
//! frames that are equal.

use foveate_camera::{Camera, CameraConfig, RegionClass, ZonesConfig};
use foveate_engine::{Engine, EngineError, EngineOptions, InstructionSet};
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;
use proptest::prelude::*;

use crate::clip_script::{clip, scripts};
use crate::properties::assert_same;
use crate::random_cameras::zoned_cameras;

/// The next map after `last`: the same one, one class everywhere, or new classes in some regions.
fn next_map(last: &[RegionClass], seed: u64) -> Vec<RegionClass> {
    let class = |number: u64| RegionClass::from_code((number % 4) as u8).unwrap();
    let hash = |region: usize| {
        let mixed = (seed ^ (region as u64) << 32).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 33
    };
    match seed % 4 {
        0 => last.to_vec(),
        1 => vec![class(seed / 4); last.len()],
        _ => {
            let next = |(region, &own): (usize, &RegionClass)| match hash(region) {
                number if number % 3 == 0 => class(number / 3),
                _ => own,
            };
            last.iter().enumerate().map(next).collect()
        }
    }
}

fn check(camera: &Camera, frames: &[Frame], seeds: &[u64], options: EngineOptions) {
    let mut model = FunctionalCamera::new(camera);
    let mut engine = Engine::with_options(camera, options).unwrap();
    let mut map = model.classes().to_vec();
    for (number, (frame, &seed)) in frames.iter().zip(seeds).enumerate() {
        map = next_map(&map, seed);
        model.set_classes(&map).unwrap();
        engine.set_classes(&map).unwrap();
        let expected = model.step(frame).unwrap();
        let context = format!("frame {number}, {map:?}, {options:?}, {:?}", camera.config());
        assert_same(engine.step(frame).unwrap(), expected, &context);
        assert_eq!(engine.rendered().to_words(), expected.rendered.pixels(), "screen, {context}");
    }
    // The map stays at a reset.
    if let Some(frame) = frames.last() {
        model.reset();
        engine.reset();
        assert_same(engine.step(frame).unwrap(), model.step(frame).unwrap(), "after a reset");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(500)))]

    #[test]
    fn zones_of_the_engine_equal_those_of_the_model(
        camera in zoned_cameras(),
        (seed, script) in scripts(),
        seeds in proptest::collection::vec(any::<u64>(), 9),
        (threads, skips_identical_regions) in (1usize..=2, any::<bool>()),
        level in proptest::sample::select(InstructionSet::available()),
    ) {
        let options = EngineOptions { threads, skips_identical_regions, level };
        check(&camera, &clip(&camera, seed, &script), &seeds, options);
    }
}

/// Equal frames are skipped after the first ones, but a region whose class changes is not.
#[test]
fn a_new_class_is_computed_although_nothing_changes() {
    let text = "frame={width=640,height=96}\nspatial=[{feature=\"edge\",level=300,min_score=3}]\n\
                temporal={reference=\"last-sent\"}\nrender={irrelevant=\"hold\"}\n";
    let mut config = CameraConfig::from_toml(text).unwrap();
    config.zones = Some(ZonesConfig::default());
    let camera = config.validate().unwrap();
    let pixel = |x: u32, y: u32| ((x * x + 3 * y * y + x * y) % 256) as u16;
    let frame = Frame::from_fn(640, 96, 8, pixel).unwrap();
    let mut engine = Engine::new(&camera);
    let regions = camera.regions() as usize;
    for _ in 0..6 {
        engine.step(&frame).unwrap();
    }
    assert_eq!(engine.outcome().skipped, regions, "the frames are skipped");
    let before = engine.outcome().srs[5];
    let mut map = vec![RegionClass::Normal; regions];
    map[5] = if before { RegionClass::Off } else { RegionClass::Always };
    engine.set_classes(&map).unwrap();
    let outcome = engine.step(&frame).unwrap();
    assert_eq!(outcome.srs[5], !before);
    assert!(outcome.skipped >= regions - 2, "{} of {regions}", outcome.skipped);
}

#[test]
fn a_map_that_does_not_fit_is_refused() {
    let camera = CameraConfig::from_toml("frame={width=16,height=8}\n").unwrap();
    let mut engine = Engine::new(&camera.validate().unwrap());
    let error = engine.set_classes(&[RegionClass::Off, RegionClass::Normal]).unwrap_err();
    assert!(matches!(error, EngineError::ClassMap(_)), "{error}");
    assert!(error.to_string().contains("region 0 has the class `off`"), "{error}");
}
