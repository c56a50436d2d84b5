// SPDX-License-Identifier: MIT OR Apache-2.0
//! A padded frame of real numbers with a border of one pixel around it that repeats its last pixels,
//! so that a 3x3 window is nine plain reads everywhere.

use foveate_frame::Plane as Pixels;

use crate::grid::Grid;

/// Values of a padded frame, in grey levels.
#[derive(Clone, Debug)]
pub(crate) struct Plane {
    width: usize,
    height: usize,
    /// Lines of `width + 2` values, `height + 2` of them.
    values: Vec<f64>,
}

impl Plane {
    /// All zero.
    pub(crate) fn black(grid: &Grid) -> Self {
        let (width, height) = grid.padded();
        Self { width, height, values: vec![0.0; (width + 2) * (height + 2)] }
    }

    pub(crate) fn width(&self) -> usize {
        self.width
    }

    pub(crate) fn height(&self) -> usize {
        self.height
    }

    /// A row without the border.
    pub(crate) fn row(&self, y: usize) -> &[f64] {
        &self.values[(y + 1) * (self.width + 2) + 1..][..self.width]
    }

    /// A row without the border, to be written; [`Plane::repeat_border`] comes after the last.
    pub(crate) fn row_mut(&mut self, y: usize) -> &mut [f64] {
        &mut self.values[(y + 1) * (self.width + 2) + 1..][..self.width]
    }

    /// The lines above, at and below row `y`, each with one value more at both ends: the window around
    /// column `x` is at `x..x + 3`.
    pub(crate) fn around(&self, y: usize) -> [&[f64]; 3] {
        let stride = self.width + 2;
        [y, y + 1, y + 2].map(|line| &self.values[line * stride..][..stride])
    }

    /// Takes a frame and repeats its last column and row until it is a whole number of regions.
    pub(crate) fn pad(&mut self, pixels: Pixels<'_>, grid: &Grid) {
        match pixels {
            Pixels::Bytes(pixels) => self.pad_from(pixels, grid),
            Pixels::Words(pixels) => self.pad_from(pixels, grid),
        }
        self.repeat_border();
    }

    fn pad_from<T: Copy + Into<f64>>(&mut self, pixels: &[T], grid: &Grid) {
        for y in 0..self.height {
            let source = &pixels[y.min(grid.height - 1) * grid.width..][..grid.width];
            let (own, padding) = self.row_mut(y).split_at_mut(grid.width);
            for (value, &pixel) in own.iter_mut().zip(source) {
                *value = pixel.into();
            }
            padding.fill(*own.last().expect("a frame has pixels"));
        }
    }

    /// Fills the border with the nearest pixels of the frame.
    pub(crate) fn repeat_border(&mut self) {
        let stride = self.width + 2;
        for line in self.values.chunks_exact_mut(stride).skip(1).take(self.height) {
            line[0] = line[1];
            line[stride - 1] = line[stride - 2];
        }
        self.values.copy_within(stride..2 * stride, 0);
        let last = self.height * stride;
        self.values.copy_within(last..last + stride, last + stride);
    }

    /// Takes the values of a plane of the same size.
    pub(crate) fn copy(&mut self, from: &Self) {
        self.values.copy_from_slice(&from.values);
    }

    /// Copies the frame without its padding.
    pub(crate) fn crop_into(&self, grid: &Grid, out: &mut [f64]) {
        for (y, row) in out.chunks_exact_mut(grid.width).enumerate() {
            row.copy_from_slice(&self.row(y)[..grid.width]);
        }
    }
}
