// SPDX-License-Identifier: MIT OR Apache-2.0
//! The screen: what remains of each region after its action.

use foveate_camera::Camera;

use crate::region::{Area, black_padded, crop_into};
use foveate_camera::Action;
use foveate_frame::Frame;

/// The rendered regions, padding included; black before the first frame.
#[derive(Clone, Debug)]
pub(crate) struct Screen(Frame);

impl Screen {
    /// A black screen.
    pub(crate) fn black(camera: &Camera) -> Self {
        Self(black_padded(camera))
    }

    /// Renders one region of a frame whose pixels are `payload`.
    pub(crate) fn show(&mut self, area: Area, action: Action, payload: &Frame) {
        match action {
            Action::Forward => area.copy(payload, &mut self.0),
            Action::Hold => {}
            Action::Blank => area.blank(&mut self.0),
        }
    }

    /// What is seen: the screen without padding.
    pub(crate) fn crop_into(&self, rendered: &mut Frame) {
        crop_into(&self.0, rendered);
    }
}
