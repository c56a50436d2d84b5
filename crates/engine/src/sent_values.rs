// SPDX-License-Identifier: MIT OR Apache-2.0
//! The values that a region sends: denoised pixels, raw pixels, or means.

use foveate_camera::{Camera, RegionAction};
use foveate_pixels::FramePixels;

use crate::Engine;
use crate::plan::index;

impl Engine {
    /// Appends the values that a region of the last frame sends: the pixels of an active region,
    /// with its padding, in row-major order, or the means of its summary. Appends nothing for a
    /// region that sends nothing. `raw` are the pixels of the last frame, as the engine took them.
    ///
    /// # Panics
    /// Panics if the camera has no such region, or if `raw` is smaller than its frame.
    pub fn sent_values(&self, raw: FramePixels<'_>, region: u32, values: &mut Vec<u16>) {
        match self.outcome().actions[index(region)] {
            RegionAction::Forward if self.camera().has_separate_raw_pixels() => {
                append_raw_region(self.camera(), raw, region, values);
            }
            RegionAction::Forward => self.denoised_region(region, values),
            RegionAction::Summarize => self.summary(region, values),
            RegionAction::Hold | RegionAction::Blank => {}
        }
    }
}

/// Appends the raw pixels of a region. Beyond the frame its last column and row are repeated.
fn append_raw_region(camera: &Camera, raw: FramePixels<'_>, region: u32, values: &mut Vec<u16>) {
    let side = camera.region_size();
    let (left, top) = (region % camera.columns() * side, region / camera.columns() * side);
    for y in top..top + side {
        let row = y.min(camera.height() - 1) * camera.width();
        let places = (left..left + side).map(|x| index(row + x.min(camera.width() - 1)));
        match raw {
            FramePixels::Bytes(pixels) => {
                values.extend(places.map(|place| u16::from(pixels[place])));
            }
            FramePixels::Words(pixels) => values.extend(places.map(|place| pixels[place])),
        }
    }
}
