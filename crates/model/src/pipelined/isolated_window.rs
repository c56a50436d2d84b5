// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window stage of an isolated region: it takes n pixels and gives n centers, N + 1 advances
//! later.
//!
//! ```text
//! N = 2               one frame, silence        the next frame follows at once
//! edge                 0  1  2  3  4  5  6      0  1  2  3  4  5  6  7
//! pixel taken         a0 a1 a2 a3  -  -  -     a0 a1 a2 a3 b0 b1 b2 b3
//! center given         -  -  - a0 a1 a2 a3      -  -  - a0 a1 a2 a3 b0
//! position after       1  2  3  0  0  0  0      1  2  3  0  1  2  3  0
//! owed after           0  0  0  3  2  1  0      0  0  0  3  2  1  0  3
//! ```
//!
//! When the last pixel of a frame has come, N + 1 centers are *owed*. They leave one at every edge
//! (flush) until the next frame begins, and from then on one with every pixel. All have left before
//! pixel N + 1 of the next frame comes.

use super::pixel::StagePixel;
use super::window_center::WindowCenters;

/// The window stage with all pixels of the current frame and of the frame before, in all lanes. The
/// hardware stores two rows, which is enough. Whole frames make the model easier to check.
#[derive(Clone, Debug)]
pub(super) struct IsolatedWindow {
    side: usize,
    /// The frame whose pixels are being taken: at each position, the pixels of all lanes.
    current: Vec<Vec<StagePixel>>,
    /// The frame that was taken before it.
    previous: Vec<Vec<StagePixel>>,
    /// Number of pixels of the current frame that have been taken, 0..n.
    position: usize,
    /// Number of centers of the previous frame that have not been given yet.
    owed: usize,
}

impl IsolatedWindow {
    pub(super) fn new(side: usize) -> Self {
        let frame = vec![Vec::new(); side * side];
        Self { side, current: frame.clone(), previous: frame, position: 0, owed: 0 }
    }

    pub(super) fn reset(&mut self) {
        self.position = 0;
        self.owed = 0;
    }

    /// Applies one edge. `pixels` has a pixel per lane.
    pub(super) fn step(&mut self, pixels: Option<Vec<StagePixel>>) -> Option<WindowCenters<'_>> {
        match pixels {
            Some(pixels) => self.take_pixels(pixels),
            // Between frames the stage flushes. Inside a frame it waits for pixels.
            None if self.position == 0 => {}
            None => return None,
        }
        let behind = self.side + 1;
        let (frame, place) = if self.owed > 0 {
            self.owed -= 1;
            (&self.previous, self.previous.len() - 1 - self.owed)
        } else {
            let last_taken = self.position.checked_sub(1)?;
            (&self.current, last_taken.checked_sub(behind)?)
        };
        let at = (place % self.side, place / self.side);
        Some(WindowCenters::at(frame, self.side, at, None))
    }

    fn take_pixels(&mut self, pixels: Vec<StagePixel>) {
        self.current[self.position] = pixels;
        self.position += 1;
        if self.position == self.current.len() {
            std::mem::swap(&mut self.current, &mut self.previous);
            self.position = 0;
            // The first of the owed centers is given at this edge.
            self.owed = self.side + 2;
        }
    }
}
