// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of zones: the functional model equals the oracle for every camera with zones, while the
//! map changes between frames, and the consequences that the contract states.

use std::slice::from_ref;

use foveate_camera::{CameraConfig, ClassMapError, RegionClass, ZonesConfig};
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;
use proptest::prelude::*;

use crate::frames::{SeededRandom, arbitrary_scripts, make_clip};
use crate::functional_properties::assert_outcome_is;
use crate::oracle::oracle_history_with_maps;
use crate::parameters::{
    DesignParameters, arbitrary_cameras, arbitrary_zoned_cameras, arbitrary_zoned_parameters,
};
use crate::pipelined_properties::{check_with_maps, gaps};

/// Returns one map per frame. A map changes in half of the frames, and then in about half of the
/// regions.
fn arbitrary_maps(recipe: &DesignParameters, frames: usize, seed: u64) -> Vec<Vec<u8>> {
    let mut random = SeededRandom(seed);
    let mut map: Vec<u8> = vec![0; (recipe.columns() * recipe.rows()) as usize];
    let mut next = || {
        if random.below(2) == 0 {
            for code in &mut map {
                if random.below(2) == 0 {
                    *code = random.below(4) as u8;
                }
            }
        }
        map.clone()
    };
    (0..frames).map(|_| next()).collect()
}

fn classes(map: &[u8]) -> Vec<RegionClass> {
    map.iter().map(|&code| RegionClass::from_code(code).unwrap()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(600)))]

    #[test]
    fn zones_equal_the_oracle(
        recipe in arbitrary_zoned_cameras(),
        script in arbitrary_scripts(8),
        seed in any::<u64>(),
    ) {
        let frames = make_clip(&recipe, &script);
        let maps = arbitrary_maps(&recipe, frames.len(), seed);
        let history = oracle_history_with_maps(&recipe, &maps, &frames);
        let mut camera = FunctionalCamera::new(&recipe.camera());
        for ((frame, map), expected) in frames.iter().zip(&maps).zip(&history) {
            camera.set_classes(&classes(map)).unwrap();
            assert_outcome_is(&recipe, camera.step(frame).unwrap(), expected);
        }
        // The map stays at a reset, and all else begins again.
        camera.reset();
        if let (Some(frame), Some(map)) = (frames.last(), maps.last()) {
            let again = oracle_history_with_maps(&recipe, from_ref(map), from_ref(frame));
            assert_outcome_is(&recipe, camera.step(frame).unwrap(), &again[0]);
        }
    }

    #[test]
    fn the_pipelined_organization_equals_the_oracle_after_every_edge(
        recipe in arbitrary_zoned_parameters(),
        script in arbitrary_scripts(6),
        seed in any::<u64>(),
        gaps in gaps(),
    ) {
        let frames = make_clip(&recipe, &script);
        check_with_maps(&recipe, &frames, &arbitrary_maps(&recipe, frames.len(), seed), gaps);
    }

    #[test]
    fn normal_regions_do_not_see_that_there_are_zones(
        recipe in arbitrary_cameras(),
        script in arbitrary_scripts(6),
    ) {
        let plain = recipe.camera();
        let mut config = plain.config().clone();
        config.zones = Some(ZonesConfig::default());
        let zoned = config.validate().unwrap();
        let (mut plain, mut zoned) = (FunctionalCamera::new(&plain), FunctionalCamera::new(&zoned));
        for frame in make_clip(&recipe, &script) {
            prop_assert_eq!(plain.step(&frame).unwrap(), zoned.step(&frame).unwrap());
        }
    }

    #[test]
    fn off_regions_are_never_active_and_always_regions_follow_trs(
        recipe in arbitrary_zoned_cameras(),
        script in arbitrary_scripts(6),
        seed in any::<u64>(),
    ) {
        let frames = make_clip(&recipe, &script);
        let mut camera = FunctionalCamera::new(&recipe.camera());
        for (frame, map) in frames.iter().zip(arbitrary_maps(&recipe, frames.len(), seed)) {
            let classes = classes(&map);
            camera.set_classes(&classes).unwrap();
            let outcome = camera.step(frame).unwrap();
            for (region, class) in classes.into_iter().enumerate() {
                let (trs, active) = (outcome.trs[region], outcome.active[region]);
                match class {
                    RegionClass::Off => prop_assert!(!active),
                    RegionClass::Always => prop_assert_eq!(active, trs),
                    RegionClass::Normal | RegionClass::Keen => {}
                }
            }
        }
    }
}

/// A region that is off sends one summary if no mean can differ by more than `off_level`.
#[test]
fn an_off_region_with_the_largest_level_sends_one_summary() {
    let text = "frame={width=8,height=8}\nrender={irrelevant=\"mean\"}\nperiphery={level=0}\n";
    let mut config = CameraConfig::from_toml(text).unwrap();
    config.zones = Some(ZonesConfig { off_level: Some(255), ..ZonesConfig::default() });
    let mut camera = FunctionalCamera::new(&config.validate().unwrap());
    let noise = |seed: u32| {
        Frame::from_fn(8, 8, 8, |x, y| ((x * 31 + y * 17 + seed * 101) % 256) as u16).unwrap()
    };
    let mut actions = |class, frames: std::ops::Range<u32>| -> Vec<&str> {
        camera.set_classes(&[class]).unwrap();
        frames.map(|seed| camera.step(&noise(seed)).unwrap().actions[0].name()).collect()
    };
    assert_eq!(actions(RegionClass::Off, 0..4), ["summarize", "hold", "hold", "hold"]);
    assert_eq!(actions(RegionClass::Always, 4..6), ["forward", "forward"]);
    assert_eq!(actions(RegionClass::Off, 6..9), ["summarize", "hold", "hold"]);
}

#[test]
fn a_refused_map_leaves_the_classes_as_they_are() {
    let mut config = CameraConfig::from_toml("frame={width=16,height=8}\n").unwrap();
    config.zones = Some(ZonesConfig::default());
    let mut camera = FunctionalCamera::new(&config.validate().unwrap());
    let keen = [RegionClass::Normal, RegionClass::Keen];
    assert_eq!(camera.set_classes(&keen), Ok(()));
    let refused = ClassMapError::Count { given: 1, regions: 2 };
    assert_eq!(camera.set_classes(&keen[..1]), Err(refused.into()));
    assert_eq!(camera.classes(), keen);
}
