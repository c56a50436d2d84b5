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
use super::window_center::{WindowCenter, center_at};

/// The window stage with all pixels of the current frame and of the frame before. The hardware
/// stores two rows, which is enough. Whole frames make the model easier to check.
#[derive(Clone, Debug)]
pub(super) struct IsolatedWindow {
    side: usize,
    /// The frame whose pixels are being taken.
    current: Vec<StagePixel>,
    /// The frame that was taken before it.
    previous: Vec<StagePixel>,
    /// Number of pixels of the current frame that have been taken, 0..n.
    position: usize,
    /// Number of centers of the previous frame that have not been given yet.
    owed: usize,
}

impl IsolatedWindow {
    pub(super) fn new(side: usize) -> Self {
        let frame = vec![StagePixel::default(); side * side];
        Self { side, current: frame.clone(), previous: frame, position: 0, owed: 0 }
    }

    pub(super) fn reset(&mut self) {
        self.position = 0;
        self.owed = 0;
    }

    pub(super) fn step(&mut self, pixel: Option<StagePixel>) -> Option<WindowCenter> {
        match pixel {
            Some(pixel) => self.take_pixel(pixel),
            // Between frames the stage flushes. Inside a frame it waits for pixels.
            None if self.position == 0 => self.flush_center(),
            None => None,
        }
    }

    fn take_pixel(&mut self, pixel: StagePixel) -> Option<WindowCenter> {
        let taken = self.position;
        self.current[taken] = pixel;
        let behind = self.side + 1;
        let taken_center = || Some(self.center(&self.current, taken.checked_sub(behind)?));
        let center = if self.owed > 0 { self.flush_center() } else { taken_center() };
        self.position = taken + 1;
        if self.position == self.current.len() {
            std::mem::swap(&mut self.current, &mut self.previous);
            self.position = 0;
            self.owed = behind;
        }
        center
    }

    fn flush_center(&mut self) -> Option<WindowCenter> {
        let place = (self.previous.len()).checked_sub(self.owed).filter(|_| self.owed > 0)?;
        self.owed -= 1;
        Some(self.center(&self.previous, place))
    }

    fn center(&self, frame: &[StagePixel], place: usize) -> WindowCenter {
        let at = (place % self.side, place / self.side);
        let last = self.side - 1;
        center_at(frame, self.side, at, (0, 0), (last, last))
    }
}
