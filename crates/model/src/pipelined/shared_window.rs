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
use super::window_center::{HiddenHalo, WindowCenters};
use crate::stream::{BOTTOM, LEFT, RIGHT, TOP};

/// The window stage with all pixels of the current square, in all lanes.
#[derive(Clone, Debug)]
pub(super) struct SharedWindow {
    side: usize,
    /// The pixels of all lanes at each position.
    square: Vec<Vec<StagePixel>>,
    /// Number of pixels of the square that have been taken.
    position: usize,
}

impl SharedWindow {
    pub(super) fn new(side: usize) -> Self {
        Self { side, square: vec![Vec::new(); side * side], position: 0 }
    }

    pub(super) fn reset(&mut self) {
        self.position = 0;
    }

    /// Applies one edge. `pixels` has a pixel per lane, and `borders` the sides of the frame that
    /// each lane touches, if windows must not use the halo there.
    pub(super) fn step<'a>(
        &'a mut self,
        pixels: Option<Vec<StagePixel>>,
        borders: Option<&'a [u8]>,
    ) -> Option<WindowCenters<'a>> {
        let taken = self.position;
        self.square[taken] = pixels?;
        self.position = (taken + 1) % self.square.len();
        let (right, below) = (taken % self.side, taken / self.side);
        let (x, y) = (right.checked_sub(1)?, below.checked_sub(1)?);
        if x == 0 || y == 0 {
            return None;
        }
        let sides = self.sides_with_halo(x, y);
        let hidden_halo =
            borders.filter(|_| sides != 0).map(|borders| HiddenHalo { sides, borders });
        Some(WindowCenters::at(&self.square, self.side, (x, y), hidden_halo))
    }

    /// Returns the sides at which a window sees the outermost pixels of the square, which are halo.
    fn sides_with_halo(&self, x: usize, y: usize) -> u8 {
        let last_inside = self.side - 2;
        [(x == 1, LEFT), (x == last_inside, RIGHT), (y == 1, TOP), (y == last_inside, BOTTOM)]
            .into_iter()
            .filter_map(|(sees_halo, side)| sees_halo.then_some(side))
            .sum()
    }
}
