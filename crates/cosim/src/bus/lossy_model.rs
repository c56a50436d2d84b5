// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functional model of a core on a bus, whose thresholds change from frame to frame and whose
//! sent regions may be lost.

use foveate_camera::{Camera, ReferencePolicy, RegionClass};
use foveate_model::{FunctionalCamera, FunctionalOutcome, RegionMemory};
use foveate_pixels::Frame;
use std::collections::BTreeSet;

/// A functional model that takes lost regions and threshold changes into account.
pub(super) struct LossyModel<'a> {
    /// The cameras that differ in their thresholds alone.
    cameras: &'a [Camera],
    model: FunctionalCamera,
    /// The index of the current camera among `cameras`.
    camera_index: usize,
    screen: Option<Frame>,
    /// The regions of the last frame that were lost.
    lost: BTreeSet<u32>,
}

impl<'a> LossyModel<'a> {
    pub(super) fn new(cameras: &'a [Camera]) -> Self {
        let model = FunctionalCamera::new(&cameras[0]);
        Self { cameras, model, camera_index: 0, screen: None, lost: BTreeSet::new() }
    }

    /// Forgets every frame. The map of classes stays.
    pub(super) fn reset(&mut self) {
        let last = std::mem::replace(self, Self::new(self.cameras));
        self.set_classes(last.model.classes());
    }

    /// Sets the map of classes of the next frames.
    pub(super) fn set_classes(&mut self, classes: &[RegionClass]) {
        self.model.set_classes(classes).expect("a map has a class for each region");
    }

    /// Marks a region of the last frame as lost. It has no `last-sent` reference until it is active
    /// again, and the screen shows no summary of it (`docs/raster.md`).
    pub(super) fn lose(&mut self, region: u32) {
        self.lost.insert(region);
    }

    /// Returns the number of regions of the last frame that were lost.
    pub(super) fn lost_regions(&self) -> u64 {
        self.lost.len() as u64
    }

    /// Returns the model in its state before the next frame, with the thresholds of `camera`.
    fn with_camera(&self, camera: &Camera) -> FunctionalCamera {
        let mut model = self.resumed_camera(camera);
        model.set_classes(self.model.classes()).expect("cameras have the same regions");
        model
    }

    fn resumed_camera(&self, camera: &Camera) -> FunctionalCamera {
        let Some(screen) = &self.screen else { return FunctionalCamera::new(camera) };
        let remembered = |region: u32| {
            let RegionMemory { reference, summary } = self.model.region_memory(region);
            match (self.lost.contains(&region), camera.temporal().reference) {
                (false, _) => RegionMemory { reference, summary },
                (true, ReferencePolicy::Previous) => RegionMemory { reference, summary: None },
                (true, ReferencePolicy::LastSent) => RegionMemory::default(),
            }
        };
        FunctionalCamera::resume(camera, screen, remembered)
            .expect("cameras differ in thresholds alone")
    }

    /// Returns the outcome that the next frame would have with the thresholds of another camera.
    /// The state of this model does not change.
    pub(super) fn outcome_with(&self, frame: &Frame, camera: &Camera) -> FunctionalOutcome {
        let mut other = self.with_camera(camera);
        other.step(frame).expect("frames are of the design").clone()
    }

    /// Processes the next frame with the thresholds of the camera with index `camera`.
    pub(super) fn step(&mut self, frame: &Frame, camera: usize) -> FunctionalOutcome {
        if camera != self.camera_index || !self.lost.is_empty() {
            self.model = self.with_camera(&self.cameras[camera]);
            self.camera_index = camera;
            self.lost.clear();
        }
        let outcome = self.model.step(frame).expect("frames are of the design").clone();
        self.screen = Some(outcome.rendered.clone());
        outcome
    }
}
