// SPDX-License-Identifier: MIT OR Apache-2.0
//! A padded frame of real numbers with a border of one pixel that repeats the outermost pixels, so
//! that every 3x3 window is nine plain reads.

use foveate_pixels::FramePixels as Pixels;

use crate::grid::RegionGrid;

/// The values of a padded frame, in grey levels.
#[derive(Clone, Debug)]
pub(crate) struct PaddedPlane {
    width: usize,
    height: usize,
    /// The values with the border: `height + 2` lines of `width + 2` values.
    values: Vec<f64>,
}

impl PaddedPlane {
    /// Creates a plane of zeros.
    pub(crate) fn black(grid: &RegionGrid) -> Self {
        let (width, height) = grid.padded_size();
        Self { width, height, values: vec![0.0; (width + 2) * (height + 2)] }
    }

    pub(crate) fn width(&self) -> usize {
        self.width
    }

    pub(crate) fn height(&self) -> usize {
        self.height
    }

    /// Returns a row without the border.
    pub(crate) fn row(&self, y: usize) -> &[f64] {
        &self.values[(y + 1) * (self.width + 2) + 1..][..self.width]
    }

    /// Returns a row without the border for writing. Call [`PaddedPlane::repeat_border`] after the
    /// last row.
    pub(crate) fn row_mut(&mut self, y: usize) -> &mut [f64] {
        &mut self.values[(y + 1) * (self.width + 2) + 1..][..self.width]
    }

    /// Returns the lines above, at and below row `y`, each with one border value at both ends. The
    /// window around column `x` is at `x..x + 3`.
    pub(crate) fn window_lines(&self, y: usize) -> [&[f64]; 3] {
        let stride = self.width + 2;
        [y, y + 1, y + 2].map(|line| &self.values[line * stride..][..stride])
    }

    /// Reads a frame, and repeats its last column and row until the frame has a whole number of
    /// regions.
    pub(crate) fn read_padded(&mut self, pixels: Pixels<'_>, grid: &RegionGrid) {
        match pixels {
            Pixels::Bytes(pixels) => self.read_padded_from(pixels, grid),
            Pixels::Words(pixels) => self.read_padded_from(pixels, grid),
        }
        self.repeat_border();
    }

    fn read_padded_from<T: Copy + Into<f64>>(&mut self, pixels: &[T], grid: &RegionGrid) {
        for y in 0..self.height {
            let source = &pixels[y.min(grid.height - 1) * grid.width..][..grid.width];
            let (pixel_values, padding) = self.row_mut(y).split_at_mut(grid.width);
            for (value, &pixel) in pixel_values.iter_mut().zip(source) {
                *value = pixel.into();
            }
            padding.fill(*pixel_values.last().expect("a frame has pixels"));
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

    /// Copies the values of a plane of the same size.
    pub(crate) fn copy_from(&mut self, from: &Self) {
        self.values.copy_from_slice(&from.values);
    }

    /// Copies the frame without its padding to `out`.
    pub(crate) fn crop_into(&self, grid: &RegionGrid, out: &mut [f64]) {
        for (y, row) in out.chunks_exact_mut(grid.width).enumerate() {
            row.copy_from_slice(&self.row(y)[..grid.width]);
        }
    }
}
