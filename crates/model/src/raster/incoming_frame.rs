// SPDX-License-Identifier: MIT OR Apache-2.0
//! The padded frame as it comes in, word by word. Beyond the frame its last column and row are
//! repeated.

use foveate_design::RasterDesign;
use foveate_frame::Frame;

use super::advances::WordPosition;
use crate::conversions::index;
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
        let left = place.column * self.word_pixels;
        let pixels: Vec<u16> = (left..left + self.word_pixels)
            .zip(port)
            .map(|(x, &pixel)| self.pixel(x, place.row, left, port, pixel))
            .collect();
        self.padded.write_row(left, place.row, &pixels);
    }

    /// Returns the pixel at (x, y), which is `own` if it lies inside of the frame.
    fn pixel(&self, x: u32, y: u32, left: u32, port: &[u16], own: u16) -> u16 {
        let last = self.width - 1;
        if y >= self.height {
            self.padded.get(x, self.height - 1)
        } else if x <= last {
            own
        } else if last >= left {
            // The last column of the frame is in the same word.
            port[index(last - left)]
        } else {
            self.padded.get(last, y)
        }
    }
}
