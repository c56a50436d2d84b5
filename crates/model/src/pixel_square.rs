// SPDX-License-Identifier: MIT OR Apache-2.0
//! A square of pixels: a region with its halo.

use crate::stream::{BOTTOM, LEFT, RIGHT, TOP};
use crate::window::PixelWindow;

/// A square of pixels in row-major order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PixelSquare {
    side: usize,
    pixels: Vec<u16>,
}

impl PixelSquare {
    /// Makes a black square.
    pub(crate) fn black(side: usize) -> Self {
        Self { side, pixels: vec![0; side * side] }
    }

    /// Replaces the pixels of the square.
    pub(crate) fn fill(&mut self, pixels: impl Iterator<Item = u16>) {
        let mut own = self.pixels.iter_mut();
        // `for_each` runs as nested loops when the pixels come from windows row by row, which is
        // faster.
        pixels.for_each(|pixel| {
            if let Some(own) = own.next() {
                *own = pixel;
            }
        });
    }

    /// Returns the pixels of the centered square of side `inner` in row-major order.
    pub(crate) fn inner_pixels(&self, inner: usize) -> impl Iterator<Item = u16> + '_ {
        let margin = (self.side - inner) / 2;
        (margin..margin + inner).flat_map(move |y| self.row(y)[margin..][..inner].iter().copied())
    }

    /// Returns the windows around the pixels of [`PixelSquare::inner_pixels`]. Beyond this square
    /// they see its nearest pixel. That happens only without a margin, in isolated regions.
    pub(crate) fn inner_windows(&self, inner: usize) -> impl Iterator<Item = PixelWindow> + '_ {
        let (margin, last) = ((self.side - inner) / 2, self.side - 1);
        let around = move |at: usize| [at.saturating_sub(1), at, (at + 1).min(last)];
        (margin..margin + inner).flat_map(move |y| {
            let [above, here, below] = around(y).map(|y| self.row(y));
            (margin..margin + inner).map(move |x| {
                let [west, x, east] = around(x);
                [
                    above[west],
                    above[x],
                    above[east],
                    here[west],
                    here[x],
                    here[east],
                    below[west],
                    below[x],
                    below[east],
                ]
            })
        })
    }

    /// Replaces the outermost pixels at the sides in `border` by their inner neighbors, so that
    /// positions beyond the frame hold the nearest pixel inside. Rows are replaced before columns,
    /// so that the columns carry the corners.
    pub(crate) fn repeat_borders(&mut self, border: u8) {
        let (side, last) = (self.side, self.side - 1);
        let names = |bit: u8| border & bit != 0;
        if names(TOP) {
            self.pixels.copy_within(side..2 * side, 0);
        }
        if names(BOTTOM) {
            self.pixels.copy_within((last - 1) * side..last * side, last * side);
        }
        for row in self.pixels.chunks_exact_mut(side) {
            if names(LEFT) {
                row[0] = row[1];
            }
            if names(RIGHT) {
                row[last] = row[last - 1];
            }
        }
    }

    fn row(&self, y: usize) -> &[u16] {
        &self.pixels[y * self.side..][..self.side]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corner_beyond_two_sides_is_the_nearest_pixel_inside() {
        let mut square = PixelSquare::black(4);
        square.fill(0..16);
        square.repeat_borders(TOP | LEFT);
        assert_eq!(square.pixels, [5, 5, 6, 7, 5, 5, 6, 7, 9, 9, 10, 11, 13, 13, 14, 15]);
        square.fill(0..16);
        square.repeat_borders(BOTTOM | RIGHT);
        assert_eq!(square.pixels, [0, 1, 2, 2, 4, 5, 6, 6, 8, 9, 10, 10, 8, 9, 10, 10]);
        assert_eq!(square.inner_pixels(2).collect::<Vec<_>>(), [5, 6, 9, 10]);
    }
}
