// SPDX-License-Identifier: MIT OR Apache-2.0
//! A model that is resumed from the copied state of an engine continues as one that has seen every
//! frame.

use foveate_engine::{Engine, RegionStateBefore};
use foveate_model::{FunctionalCamera, FunctionalOutcome, RegionMemory};
use foveate_pixels::{Frame, FramePixels};
use proptest::prelude::*;

use crate::clip_script::{clip, scripts};
use crate::random_cameras::cameras;

/// Returns the outcome of a model that is resumed from the state of an engine before its last
/// frame, and then takes that frame.
fn resumed(engine: &Engine, frame: &Frame) -> FunctionalOutcome {
    let camera = engine.camera();
    let shown = engine.rendered_before().map(FramePixels::to_words).unwrap();
    let shown = Frame::new(camera.width(), camera.height(), camera.pixel_bits(), shown).unwrap();
    let remembered = |region| {
        let RegionStateBefore { reference, summary } = engine.region_state_before(region).unwrap();
        RegionMemory { reference, summary }
    };
    let mut model = FunctionalCamera::resume(camera, &shown, remembered).unwrap();
    model.step(frame).unwrap().clone()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(100)))]

    #[test]
    fn a_model_goes_on_from_the_memory_of_an_engine(
        camera in cameras(),
        (seed, script) in scripts(),
    ) {
        let mut model = FunctionalCamera::new(&camera);
        let mut engine = Engine::new(&camera);
        prop_assert_eq!(engine.region_state_before(0), None);
        engine.set_state_copying(true);
        for frame in &clip(&camera, seed, &script) {
            engine.step(frame).unwrap();
            prop_assert_eq!(&resumed(&engine, frame), model.step(frame).unwrap());
        }
        engine.reset();
        prop_assert_eq!(engine.region_state_before(0), None);
        engine.set_state_copying(false);
        engine.step(&clip(&camera, seed, &script)[0]).unwrap();
        prop_assert_eq!(engine.region_state_before(0), None);
    }
}
