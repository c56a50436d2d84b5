// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functional model behind a bus: its thresholds change from frame to frame, and regions that were sent are lost.

use foveate_design::{Camera, Reference};
use foveate_frame::Frame;
use foveate_model::{FunctionalCamera, FunctionalOutcome, Remembered};
use std::collections::BTreeSet;

/// A model that is told what has been lost.
pub(super) struct Follower<'a> {
    /// The cameras whose thresholds may hold.
    cameras: &'a [Camera],
    model: FunctionalCamera,
    /// Which of them it is.
    camera: usize,
    screen: Option<Frame>,
    /// Regions of the last frame that were lost.
    lost: BTreeSet<u32>,
}

impl<'a> Follower<'a> {
    pub(super) fn new(cameras: &'a [Camera]) -> Self {
        let model = FunctionalCamera::new(&cameras[0]);
        Self { cameras, model, camera: 0, screen: None, lost: BTreeSet::new() }
    }

    /// Forgets every frame.
    pub(super) fn reset(&mut self) {
        *self = Self::new(self.cameras);
    }

    /// A region of the last frame was lost. It has no reference until it is active again, and the screen shows no summary
    /// of it (`docs/raster.md`).
    pub(super) fn lose(&mut self, region: u32) {
        self.lost.insert(region);
    }

    /// The model as it stands before the next frame, with the thresholds of this camera.
    fn with(&self, camera: &Camera) -> FunctionalCamera {
        let Some(screen) = &self.screen else { return FunctionalCamera::new(camera) };
        let remembered = |region: u32| {
            let Remembered { reference, summary } = self.model.remembered(region);
            match (self.lost.contains(&region), camera.temporal().reference) {
                (false, _) => Remembered { reference, summary },
                (true, Reference::Previous) => Remembered { reference, summary: None },
                (true, Reference::LastSent) => Remembered::default(),
            }
        };
        FunctionalCamera::resume(camera, screen, remembered)
            .expect("cameras differ in thresholds alone")
    }

    /// What the next frame would come to with the thresholds of another camera.
    pub(super) fn instead(&self, frame: &Frame, camera: &Camera) -> FunctionalOutcome {
        let mut other = self.with(camera);
        other.step(frame).expect("frames are of the design").clone()
    }

    /// Takes the next frame, with the thresholds of the camera of this number.
    pub(super) fn step(&mut self, frame: &Frame, camera: usize) -> FunctionalOutcome {
        if camera != self.camera || !self.lost.is_empty() {
            self.model = self.with(&self.cameras[camera]);
            self.camera = camera;
            self.lost.clear();
        }
        let outcome = self.model.step(frame).expect("frames are of the design").clone();
        self.screen = Some(outcome.rendered.clone());
        outcome
    }
}
