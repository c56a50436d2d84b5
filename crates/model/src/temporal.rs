// SPDX-License-Identifier: MIT OR Apache-2.0
//! The temporal score, which is the number of pixels that differ from the reference of their
//! region, and the references.

use foveate_camera::{Camera, ReferencePolicy};

use super::region::RegionView;
use crate::conversions::{count_true, index};
use crate::region::{RegionArea, black_padded_frame};
use foveate_camera::RegionAction;
use foveate_pixels::Frame;

/// Returns the number of changed pixels of a region: those that differ from its reference by more
/// than the level, or n if there is no valid reference.
pub fn changed_pixels(region: &impl RegionView, level: u32) -> u32 {
    match region.reference() {
        Some(before) => {
            let pairs = region.pixels().zip(before);
            count_true(pairs.map(|(now, before)| u32::from(now.abs_diff(before)) > level))
        }
        None => count_true(region.pixels().map(|_| true)),
    }
}

/// The references of all regions: denoised pixels of an earlier frame.
#[derive(Clone, Debug)]
pub(crate) struct RegionReferences {
    frame: Frame,
    valid: Vec<bool>,
}

impl RegionReferences {
    /// Makes the state in which no region has a valid reference.
    pub(crate) fn without_references(camera: &Camera) -> Self {
        Self { frame: black_padded_frame(camera), valid: vec![false; index(camera.regions())] }
    }

    /// Returns the reference of a region in row-major order, or `None` if it is not valid.
    pub(crate) fn pixels(&self, camera: &Camera, region: u32) -> Option<Vec<u16>> {
        self.frame(region)
            .map(|frame| RegionArea::from_region(camera, region).pixels(frame).collect())
    }

    /// Sets the reference of a region to `pixels`, in row-major order.
    pub(crate) fn set(&mut self, camera: &Camera, region: u32, pixels: &[u16]) {
        let area = RegionArea::from_region(camera, region);
        for (y, row) in area.rows().zip(pixels.chunks(index(area.side))) {
            self.frame.write_row(area.left, y, row);
        }
        self.valid[index(region)] = true;
    }

    /// Returns a padded frame that holds the reference of a region, or `None` if the reference is
    /// not valid.
    pub(crate) fn frame(&self, region: u32) -> Option<&Frame> {
        self.valid[index(region)].then_some(&self.frame)
    }

    pub(crate) fn update(
        &mut self,
        camera: &Camera,
        denoised: &Frame,
        region: u32,
        action: RegionAction,
    ) {
        let keep = match (camera.temporal().reference, action) {
            (ReferencePolicy::Previous, _) | (ReferencePolicy::LastSent, RegionAction::Forward) => {
                false
            }
            (ReferencePolicy::LastSent, RegionAction::Hold) => true,
            (ReferencePolicy::LastSent, RegionAction::Blank | RegionAction::Summarize) => {
                // The screen no longer shows the pixels that were sent.
                self.valid[index(region)] = false;
                true
            }
        };
        if !keep {
            RegionArea::from_region(camera, region).copy(denoised, &mut self.frame);
            self.valid[index(region)] = true;
        }
    }
}
