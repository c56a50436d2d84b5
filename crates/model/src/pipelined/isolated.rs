// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window of an isolated region: n pixels in, n centers out, N + 1 advances later.
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
//! Centers that are *owed* when the last pixel has come leave one at every edge (flush) until the
//! next frame begins; from then on one with every pixel. They are gone before pixel N + 1.

use super::center::{Center, center_at};
use super::pixel::Pixel;

/// The window, with all pixels of the frame that comes in and of the one before. (Two rows would
/// do, as they do in hardware; whole frames are easier to trust.)
#[derive(Clone, Debug)]
pub(super) struct IsolatedWindow {
    side: usize,
    /// The frame whose pixels come in.
    filling: Vec<Pixel>,
    /// The frame that came in before it.
    complete: Vec<Pixel>,
    /// Pixels of the frame that have been taken, 0..n.
    position: usize,
    /// Centers of the complete frame that have not been given yet.
    owed: usize,
}

impl IsolatedWindow {
    pub(super) fn new(side: usize) -> Self {
        let frame = vec![Pixel::default(); side * side];
        Self { side, filling: frame.clone(), complete: frame, position: 0, owed: 0 }
    }

    pub(super) fn reset(&mut self) {
        self.position = 0;
        self.owed = 0;
    }

    pub(super) fn step(&mut self, pixel: Option<Pixel>) -> Option<Center> {
        match pixel {
            Some(pixel) => self.take(pixel),
            // Between frames: flush. Inside a frame: wait for pixels.
            None if self.position == 0 => self.give_owed(),
            None => None,
        }
    }

    fn take(&mut self, pixel: Pixel) -> Option<Center> {
        let taken = self.position;
        self.filling[taken] = pixel;
        let behind = self.side + 1;
        let own = || Some(self.center(&self.filling, taken.checked_sub(behind)?));
        let center = if self.owed > 0 { self.give_owed() } else { own() };
        self.position = taken + 1;
        if self.position == self.filling.len() {
            std::mem::swap(&mut self.filling, &mut self.complete);
            self.position = 0;
            self.owed = behind;
        }
        center
    }

    fn give_owed(&mut self) -> Option<Center> {
        let place = (self.complete.len()).checked_sub(self.owed).filter(|_| self.owed > 0)?;
        self.owed -= 1;
        Some(self.center(&self.complete, place))
    }

    fn center(&self, frame: &[Pixel], place: usize) -> Center {
        let at = (place % self.side, place / self.side);
        let last = self.side - 1;
        center_at(frame, self.side, at, (0, 0), (last, last))
    }
}
