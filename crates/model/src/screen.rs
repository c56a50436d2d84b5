// SPDX-License-Identifier: MIT OR Apache-2.0
//! The screen: the pixels of each region after its action.

use foveate_camera::Camera;

use crate::region::{RegionArea, black_padded_frame, crop_into, pad_into};
use foveate_camera::RegionAction;
use foveate_pixels::Frame;

/// The rendered regions with padding. The screen is black before the first frame.
#[derive(Clone, Debug)]
pub(crate) struct Screen(Frame);

impl Screen {
    /// Makes a black screen.
    pub(crate) fn black(camera: &Camera) -> Self {
        Self(black_padded_frame(camera))
    }

    /// Renders one region of a frame with the forwarded pixels `payload` and the means `means`.
    pub(crate) fn show_region(
        &mut self,
        camera: &Camera,
        region: u32,
        action: RegionAction,
        (payload, means): (&Frame, &[u16]),
    ) {
        let area = RegionArea::from_region(camera, region);
        match action {
            RegionAction::Forward => area.copy(payload, &mut self.0),
            RegionAction::Hold => {}
            RegionAction::Blank => area.blank(&mut self.0),
            RegionAction::Summarize => {
                let periphery = camera.periphery().expect("who sends a summary has a periphery");
                area.fill_blocks(periphery, means, &mut self.0);
            }
        }
    }

    /// Shows a whole frame, which has the size of the screen without padding.
    pub(crate) fn show_frame(&mut self, frame: &Frame) {
        pad_into(frame, &mut self.0);
    }

    /// Copies the screen without padding to `rendered`.
    pub(crate) fn crop_into(&self, rendered: &mut Frame) {
        crop_into(&self.0, rendered);
    }
}
