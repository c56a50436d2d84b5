// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pixels that are not a frame of the camera are refused by name, and change nothing.

use foveate_camera::{Camera, CameraConfig};
use foveate_engine::{BatchScreens, Engine, EngineError, EngineOptions, FrameOutcome, MAX_THREADS};
use foveate_pixels::Frame;

fn camera(bits: u32) -> Camera {
    let mut config = CameraConfig::default();
    (config.frame.width, config.frame.height) = (Some(20), Some(9));
    config.frame.pixel_bits = bits;
    config.validate().unwrap()
}

fn message(result: Result<&FrameOutcome, EngineError>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn what_is_no_frame_of_the_design_is_refused() {
    let mut engine = Engine::new(&camera(6));
    let other = Frame::filled(20, 9, 8, 1).unwrap();
    assert_eq!(
        message(engine.step(&other)),
        "the frame has 20x9 pixels of 8 bits, but the camera takes 20x9 pixels of 6 bits; give it \
         frames of that kind"
    );
    assert_eq!(
        message(engine.step_u8(&[0; 179], 20)),
        "179 pixels with a stride of 20 do not hold a frame of 20x9; the stride must be at least 20, \
         and 180 pixels are needed"
    );
    assert!(engine.step_u8(&[0; 1000], 19).is_err());
    assert!(engine.step_u8(&[0; 1000], usize::MAX).is_err());
    let mut pixels = [63; 8 * 30 + 20];
    // The engine does not read the values between the rows.
    pixels[25] = 200;
    assert!(engine.step_u8(&pixels, 30).is_ok());
    let before = (engine.outcome().clone(), engine.rendered().to_words());
    pixels[30 + 7] = 64;
    let refused = message(engine.step_u8(&pixels, 30));
    assert_eq!(refused, "pixel (7, 1) is 64; the largest value of 6 bits is 63");
    assert_eq!((engine.outcome().clone(), engine.rendered().to_words()), before);
    let refused = message(engine.step_u16(&[0; 180], 20));
    assert_eq!(refused, "pixels of 6 bits need the type u8, but u16 was given");
    assert!(Engine::new(&camera(9)).step_u8(&[0; 180], 20).is_err());
}

#[test]
fn more_threads_than_help_are_refused_before_one_is_started() {
    for threads in [MAX_THREADS + 1, 1_000_000, usize::MAX] {
        let options = EngineOptions { threads, ..EngineOptions::default() };
        let refusal = Engine::with_options(&camera(6), options).unwrap_err().to_string();
        let right = "expected 1 to 256, or 0, which takes one per processor";
        assert_eq!(refusal, format!("threads = {threads}: {right}"));
    }
    for threads in [0, MAX_THREADS] {
        let options = EngineOptions { threads, ..EngineOptions::default() };
        assert!(Engine::with_options(&camera(6), options).is_ok());
    }
}

#[test]
fn batches_with_a_wrong_frame_change_nothing() {
    fn refused<T: std::fmt::Debug>(result: Result<T, EngineError>) -> String {
        result.unwrap_err().to_string()
    }
    let mut engine = Engine::new(&camera(6));
    let (good, bad) = (&[9; 180][..], &[64; 180][..]);
    engine.step_batch_u8(&[good, good], 20, None).unwrap();
    let before = (engine.outcome().clone(), engine.rendered().to_words());
    assert_eq!(
        refused(engine.step_batch_u8(&[good, good, bad], 20, None)),
        "frame 2 of the batch: pixel (0, 0) is 64; the largest value of 6 bits is 63"
    );
    assert_eq!(
        refused(engine.step_batch_u8(&[&good[1..]], 20, None)),
        "frame 0 of the batch: 179 pixels with a stride of 20 do not hold a frame of 20x9; the stride \
         must be at least 20, and 180 pixels are needed"
    );
    assert_eq!(
        refused(engine.step_batch_u16(&[&[0; 180]], 20, None)),
        "pixels of 6 bits need the type u8, but u16 was given"
    );
    let mut screens = BatchScreens::new();
    engine.step_batch_u8(&[good], 20, Some(&mut screens)).unwrap();
    assert!(engine.step_batch_u8(&[bad], 20, Some(&mut screens)).is_err());
    assert_eq!(screens.get(0).map(<[u8]>::to_vec), Some(vec![0; 180]));
    assert_eq!(screens.get(1), None);
    assert!(Engine::new(&camera(9)).step_batch_u8(&[good], 20, None).is_err());
    assert_eq!((engine.outcome().clone(), engine.rendered().to_words()), before);
    assert!(engine.step_batch_u8(&[], 20, None).unwrap().is_empty());
    assert_eq!((engine.outcome().clone(), engine.rendered().to_words()), before);
}
