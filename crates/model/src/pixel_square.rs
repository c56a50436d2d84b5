// SPDX-License-Identifier: MIT OR Apache-2.0
//! A square of pixels: a region with its halo.

use crate::stream::{BOTTOM, LEFT, RIGHT, TOP};
use crate::window::PixelWindow;

/// A square of pixels in row-major order. Around it is a guard, one pixel wide, in which its
/// outermost pixels are repeated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PixelSquare {
    side: usize,
    /// The square with its guard.
    guarded: Vec<u16>,
}

impl PixelSquare {
    /// Makes a black square.
    pub(crate) fn black(side: usize) -> Self {
        Self { side, guarded: vec![0; (side + 2) * (side + 2)] }
    }

    /// Replaces the pixels of the square.
    pub(crate) fn fill(&mut self, mut pixels: impl Iterator<Item = u16>) {
        for row in self.rows_mut() {
            row.iter_mut().zip(&mut pixels).for_each(|(own, pixel)| *own = pixel);
        }
        self.repeat_guard();
    }

    /// Replaces the pixels of the square by the values of windows of another square: those around
    /// the pixels of its centered square that is as large as this one.
    pub(crate) fn fill_from_windows(&mut self, other: &Self, value: impl Fn(&PixelWindow) -> u16) {
        let side = self.side;
        for (y, row) in self.rows_mut().enumerate() {
            let windows = other.inner_row_windows(side, y);
            row.iter_mut().zip(windows).for_each(|(own, window)| *own = value(&window));
        }
        self.repeat_guard();
    }

    /// Returns the pixels of the centered square of side `inner` in row-major order.
    pub(crate) fn inner_pixels(&self, inner: usize) -> impl Iterator<Item = u16> + '_ {
        self.inner_rows(inner).flatten().copied()
    }

    /// Returns the rows of the centered square of side `inner`.
    pub(crate) fn inner_rows(&self, inner: usize) -> impl Iterator<Item = &[u16]> + '_ {
        let margin = 1 + (self.side - inner) / 2;
        (margin..margin + inner).map(move |y| &self.guarded_row(y)[margin..][..inner])
    }

    /// Returns the windows around the pixels of [`PixelSquare::inner_pixels`]. They see the guard
    /// only in isolated regions, where there is no margin.
    pub(crate) fn inner_windows(&self, inner: usize) -> impl Iterator<Item = PixelWindow> + '_ {
        (0..inner).flat_map(move |y| self.inner_row_windows(inner, y))
    }

    /// Returns the windows of row `y` of [`PixelSquare::inner_windows`].
    fn inner_row_windows(&self, inner: usize, y: usize) -> impl Iterator<Item = PixelWindow> + '_ {
        let margin = (self.side - inner) / 2;
        let threes = |y| self.guarded_row(margin + y)[margin..][..inner + 2].windows(3);
        threes(y).zip(threes(y + 1)).zip(threes(y + 2)).map(|((above, here), below)| {
            std::array::from_fn(|place| [above, here, below][place / 3][place % 3])
        })
    }

    /// Replaces the outermost pixels at the sides in `border` by their inner neighbors, so that
    /// positions beyond the frame hold the nearest pixel inside.
    pub(crate) fn repeat_borders(&mut self, border: u8) {
        self.repeat_inner_neighbors(1, border);
        self.repeat_guard();
    }

    /// Repeats the outermost pixels of the square in the guard.
    fn repeat_guard(&mut self) {
        self.repeat_inner_neighbors(0, TOP | BOTTOM | LEFT | RIGHT);
    }

    /// Replaces the pixels of some sides by their inner neighbors: those of the guard for `ring` 0,
    /// the outermost of the square for 1. Rows are replaced before columns, so that the columns
    /// carry the corners.
    fn repeat_inner_neighbors(&mut self, ring: usize, sides: u8) {
        let stride = self.side + 2;
        let (first, last) = (ring, stride - 1 - ring);
        let names = |bit: u8| sides & bit != 0;
        let row = |y: usize| y * stride..(y + 1) * stride;
        if names(TOP) {
            self.guarded.copy_within(row(first + 1), first * stride);
        }
        if names(BOTTOM) {
            self.guarded.copy_within(row(last - 1), last * stride);
        }
        for row in self.guarded.chunks_exact_mut(stride) {
            if names(LEFT) {
                row[first] = row[first + 1];
            }
            if names(RIGHT) {
                row[last] = row[last - 1];
            }
        }
    }

    /// Returns the rows of the square without the guard.
    fn rows_mut(&mut self) -> impl Iterator<Item = &mut [u16]> {
        let side = self.side;
        let rows = self.guarded.chunks_exact_mut(side + 2).skip(1).take(side);
        rows.map(move |row| &mut row[1..=side])
    }

    /// Returns row `y` of the square with its guard.
    fn guarded_row(&self, y: usize) -> &[u16] {
        let stride = self.side + 2;
        &self.guarded[y * stride..][..stride]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corner_beyond_two_sides_is_the_nearest_pixel_inside() {
        let pixels = |square: &PixelSquare| square.inner_pixels(4).collect::<Vec<_>>();
        let mut square = PixelSquare::black(4);
        square.fill(0..16);
        square.repeat_borders(TOP | LEFT);
        assert_eq!(pixels(&square), [5, 5, 6, 7, 5, 5, 6, 7, 9, 9, 10, 11, 13, 13, 14, 15]);
        square.fill(0..16);
        square.repeat_borders(BOTTOM | RIGHT);
        assert_eq!(pixels(&square), [0, 1, 2, 2, 4, 5, 6, 6, 8, 9, 10, 10, 8, 9, 10, 10]);
        assert_eq!(square.inner_pixels(2).collect::<Vec<_>>(), [5, 6, 9, 10]);
    }
}
