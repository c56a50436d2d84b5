// SPDX-License-Identifier: MIT OR Apache-2.0
//! The padded frame as it comes in, word by word. Beyond the frame its last column and row are
//! repeated.

use foveate_design::RasterDesign;
use foveate_pixels::Frame;

use super::advances::WordPosition;
use crate::region::black_padded_frame;

/// The raw pixels of the current frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct IncomingFrame {
    padded: Frame,
    /// Width of the frame without padding.
    width: u32,
    height: u32,
    /// Number of pixels of a word, K.
    word_pixels: u32,
}

impl IncomingFrame {
    pub(super) fn new(design: RasterDesign<'_>) -> Self {
        Self {
            padded: black_padded_frame(&design),
            width: design.width(),
            height: design.height(),
            word_pixels: design.pixels_per_clock(),
        }
    }

    /// Returns the padded frame, as far as it has come in.
    pub(super) fn padded(&self) -> &Frame {
        &self.padded
    }

    /// Writes a word, in the order of the advances. `port` is used only for pixels of the frame
    /// itself.
    pub(super) fn write(&mut self, place: WordPosition, port: &[u16]) {
        let y = place.row;
        for (x, &own) in (place.column * self.word_pixels..).zip(port) {
            let is_inside = x < self.width && y < self.height;
            let pixel = if is_inside { own } else { self.nearest_pixel(x, y) };
            self.padded.set(x, y, pixel);
        }
    }

    /// Returns the pixel of the frame that is nearest to (x, y). It has come in before.
    fn nearest_pixel(&self, x: u32, y: u32) -> u16 {
        self.padded.get(x.min(self.width - 1), y.min(self.height - 1))
    }
}
