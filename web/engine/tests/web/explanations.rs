// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the engine's explanation of the last frame equals that of the model, which has seen
//! every frame.

use crate::cameras::{SIZE, classes, configurations, frame, grey};
use foveate_model::{
    FunctionalCamera,
    explanation::{FrameIdentification, RegionExplanation},
};
use foveate_web::PageCameras;

#[test]
fn every_region_of_every_frame_is_explained_as_by_the_model() {
    let (mut compared, mut with_summary, mut without_reference) = (0, 0, 0);
    for toml in configurations() {
        let mut desk = PageCameras::default();
        let (handle, _) = desk.configure(toml.as_bytes(), SIZE).unwrap();
        let design = desk.camera(handle).unwrap().design().clone();
        let mut model = FunctionalCamera::new(&design);
        for number in 0..5 {
            let grey = grey(&mut desk, number * 4);
            let camera = desk.camera(handle).unwrap();
            camera.step_grey(&grey, Some(u64::from(number) * 7)).unwrap();
            let before: Vec<_> =
                (0..design.regions()).map(|region| model.region_memory(region)).collect();
            let outcome = model.step(&frame(&grey, design.pixel_bits())).unwrap();
            let moment = FrameIdentification {
                number: number.into(),
                name: "here",
                t_us: u64::from(number) * 7,
            };
            for (region, before) in (0..).zip(before) {
                let expected =
                    RegionExplanation::from_outcome(&design, moment, region, before, outcome);
                let place = (region % design.columns(), region / design.columns());
                let told = camera.explain(place, "here").unwrap();
                assert_eq!(told, expected, "{toml}");
                with_summary += usize::from(told.summary.is_some_and(|own| own.shown.is_some()));
                without_reference += usize::from(told.temporal.reference.is_none());
                compared += 1;
            }
        }
    }
    assert!(
        with_summary > 30 && without_reference > 99,
        "of {compared}, {with_summary} with a summary and {without_reference} without a reference"
    );
}

#[test]
fn what_is_not_there_cannot_be_explained() {
    let mut desk = PageCameras::default();
    let (handle, _) = desk.configure(b"", SIZE).unwrap();
    let camera = desk.camera(handle).unwrap();
    let refused = |camera: &foveate_web::LiveCamera, place| {
        camera.explain(place, "").unwrap_err().to_string()
    };
    assert!(refused(camera, (0, 0)).contains("no frame yet"));
    camera.step_grey(&[0; 61 * 43], None).unwrap();
    assert!(refused(camera, (8, 0)).contains("the frame has 8 x 6 regions"));
    assert!(camera.explain((7, 5), "").is_ok());
    camera.reset();
    assert!(refused(camera, (0, 0)).contains("no frame yet"));
}

#[test]
fn a_frame_is_explained_with_the_classes_that_it_had() {
    let mut desk = PageCameras::default();
    let (handle, _) = desk.configure(b"[zones]\n", SIZE).unwrap();
    let regions = desk.camera(handle).unwrap().design().regions();
    desk.set_classes(handle, &classes(regions, 0)).unwrap();
    let grey = grey(&mut desk, 0);
    desk.camera(handle).unwrap().step_grey(&grey, None).unwrap();
    let explain =
        |desk: &mut PageCameras| desk.camera(handle).unwrap().explain((3, 0), "").unwrap();
    let before = explain(&mut desk);
    assert!(before.to_string().contains("off"), "{before}");
    // The map of the next frame does not change what is said about the last one.
    desk.set_classes(handle, &vec![3; regions as usize]).unwrap();
    let fingerprint = before.design_fingerprint.clone();
    let after = RegionExplanation { design_fingerprint: fingerprint, ..explain(&mut desk) };
    assert_eq!(after, before);
}
