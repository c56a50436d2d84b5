// SPDX-License-Identifier: MIT OR Apache-2.0
//! The temporal score: how many pixels differ from the region's reference, and what the reference
//! is.

use foveate_camera::{Camera, Reference};

use crate::number::{count, index};
use crate::region::{Area, black_padded};
use crate::view::RegionView;
use foveate_camera::Action;
use foveate_frame::Frame;

/// `|now - reference|` of every pixel of a region of two padded frames, row by row; a pixel has
/// changed when this is above the level.
///
/// # Panics
/// When a frame is not as large as the camera's padded frame, or has no such region.
#[must_use]
pub fn temporal_differences(
    camera: &Camera,
    now: &Frame,
    reference: &Frame,
    region: u32,
) -> Vec<u32> {
    let area = Area::of(camera, region);
    let pairs = area.pixels(now).zip(area.pixels(reference));
    pairs.map(|(now, reference)| now.abs_diff(reference).into()).collect()
}

/// Changed pixels of a region: those that differ from its reference by more than the level; all of them where there is
/// no valid reference.
pub fn changed_pixels(region: &impl RegionView, level: u32) -> u32 {
    match region.before() {
        Some(before) => {
            let pairs = region.pixels().zip(before);
            count(pairs.map(|(now, before)| u32::from(now.abs_diff(before)) > level))
        }
        None => count(region.pixels().map(|_| true)),
    }
}

/// The reference of every region: its denoised pixels as they once were.
#[derive(Clone, Debug)]
pub(crate) struct References {
    frame: Frame,
    valid: Vec<bool>,
}

impl References {
    /// No region has a reference yet.
    pub(crate) fn none(camera: &Camera) -> Self {
        Self { frame: black_padded(camera), valid: vec![false; index(camera.regions())] }
    }

    /// The reference of a region, row by row, if it is valid.
    pub(crate) fn pixels(&self, camera: &Camera, region: u32) -> Option<Vec<u16>> {
        self.frame(region).map(|frame| Area::of(camera, region).pixels(frame).collect())
    }

    /// Makes pixels, row by row, the reference of a region.
    pub(crate) fn set(&mut self, camera: &Camera, region: u32, pixels: &[u16]) {
        let area = Area::of(camera, region);
        for (y, row) in area.rows().zip(pixels.chunks(index(area.side))) {
            self.frame.write(area.left, y, row);
        }
        self.valid[index(region)] = true;
    }

    /// A padded frame with the reference of a region in its place, if that is valid.
    pub(crate) fn frame(&self, region: u32) -> Option<&Frame> {
        self.valid[index(region)].then_some(&self.frame)
    }

    /// What the next frame will be compared with, now that this frame's action is known.
    pub(crate) fn update(
        &mut self,
        camera: &Camera,
        denoised: &Frame,
        region: u32,
        action: Action,
    ) {
        let keep = match (camera.temporal().reference, action) {
            (Reference::Previous, _) | (Reference::LastSent, Action::Forward) => false,
            (Reference::LastSent, Action::Hold) => true,
            (Reference::LastSent, Action::Blank | Action::Summarize) => {
                // What was sent is no longer on the screen.
                self.valid[index(region)] = false;
                true
            }
        };
        if !keep {
            Area::of(camera, region).copy(denoised, &mut self.frame);
            self.valid[index(region)] = true;
        }
    }
}
