// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window stage of a shared region: it takes a square of side S and gives the centers that have
//! all their neighbors.
//!
//! ```text
//! S = 4                row 2                       row 3
//! pixel taken          (0,2) (1,2) (2,2) (3,2)     (0,3) (1,3) (2,3) (3,3)
//! center given           -     -   (1,1) (2,1)       -     -   (1,2) (2,2)
//! ```
//!
//! A center leaves at the edge that takes the pixel below and to the right of it, so there is no
//! flush.

use super::pixel::StagePixel;
use super::window_center::{WindowCenter, center_at};

use crate::stream::{BOTTOM, LEFT, RIGHT, TOP};

/// The window stage with all pixels of the current square.
#[derive(Clone, Debug)]
pub(super) struct SharedWindow {
    side: usize,
    square: Vec<StagePixel>,
    /// Number of pixels of the square that have been taken.
    position: usize,
}

impl SharedWindow {
    pub(super) fn new(side: usize) -> Self {
        Self { side, square: vec![StagePixel::default(); side * side], position: 0 }
    }

    pub(super) fn reset(&mut self) {
        self.position = 0;
    }

    pub(super) fn step(&mut self, pixel: Option<StagePixel>, border: u8) -> Option<WindowCenter> {
        let taken = self.position;
        self.square[taken] = pixel?;
        self.position = (taken + 1) % self.square.len();
        let (x, y) = (taken % self.side, taken / self.side);
        if x < 2 || y < 2 {
            return None;
        }
        // The outermost pixels of the square are halo. At a side of the frame the window must not
        // use them.
        let inset = |side: u8| usize::from(border & side != 0);
        let last = self.side - 1;
        let low = (inset(LEFT), inset(TOP));
        let high = (last - inset(RIGHT), last - inset(BOTTOM));
        Some(center_at(&self.square, self.side, (x - 1, y - 1), low, high))
    }
}
