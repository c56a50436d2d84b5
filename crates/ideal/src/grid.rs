// SPDX-License-Identifier: MIT OR Apache-2.0
//! The division of a frame into regions.

use std::ops::Range;

use foveate_camera::Camera;

/// The size of a frame in pixels and in regions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionGrid {
    /// The width of the frame without padding, in pixels.
    pub(crate) width: usize,
    /// The height of the frame without padding, in pixels.
    pub(crate) height: usize,
    /// The side of a region in pixels.
    pub(crate) side: usize,
    /// The number of columns of regions.
    pub(crate) columns: usize,
    /// The number of rows of regions.
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
