// SPDX-License-Identifier: MIT OR Apache-2.0
//! The places of a frame of real numbers. A [`PaddedPlane`] has a border of one pixel that
//! repeats the outermost pixels, so that every 3x3 window is nine plain reads, and a
//! [`RegionGrid`] divides it into regions.

use foveate_camera::Camera;
use foveate_pixels::FramePixels as Pixels;
use std::ops::Range;

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

/// The size of a frame in pixels and in regions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionGrid {
    /// The width of the frame without padding, in pixels.
    pub(crate) width: usize,
    /// The height of the frame without padding, in pixels.
    pub(crate) height: usize,
    /// The side of a region in pixels.
    pub(crate) side: usize,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl RegionGrid {
    pub(crate) fn from_camera(camera: &Camera) -> Self {
        Self {
            width: to_index(camera.width()),
            height: to_index(camera.height()),
            side: to_index(camera.region_size()),
            columns: to_index(camera.columns()),
            rows: to_index(camera.rows()),
        }
    }

    /// Returns the number of regions of a frame.
    pub(crate) fn regions(&self) -> usize {
        self.columns * self.rows
    }

    /// Returns the width and height of the padded frame in pixels.
    pub(crate) fn padded_size(&self) -> (usize, usize) {
        (self.columns * self.side, self.rows * self.side)
    }

    /// Returns the numbers of the regions that row `y` of the padded frame crosses, from left to
    /// right.
    pub(crate) fn regions_of_row(&self, y: usize) -> Range<usize> {
        let first = y / self.side * self.columns;
        first..first + self.columns
    }

    /// Returns the columns and rows of a region in the padded frame.
    pub(crate) fn area(&self, region: usize) -> (Range<usize>, Range<usize>) {
        let (left, top) = (region % self.columns * self.side, region / self.columns * self.side);
        (left..left + self.side, top..top + self.side)
    }

    /// Returns the columns and rows of a region without padding.
    pub(crate) fn area_without_padding(&self, region: usize) -> (Range<usize>, Range<usize>) {
        let (columns, rows) = self.area(region);
        (columns.start..columns.end.min(self.width), rows.start..rows.end.min(self.height))
    }
}

/// Converts a size to an index. It loses nothing, because `usize` has at least 32 bits on every
/// platform that can hold a frame.
pub(crate) const fn to_index(value: u32) -> usize {
    value as usize
}
