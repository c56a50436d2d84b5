// SPDX-License-Identifier: MIT OR Apache-2.0
//! The division of a frame into regions.

use std::ops::Range;

use foveate_camera::Camera;

/// The size of a frame in pixels and in regions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
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

impl Grid {
    pub(crate) fn of(camera: &Camera) -> Self {
        Self {
            width: index(camera.width()),
            height: index(camera.height()),
            side: index(camera.region_size()),
            columns: index(camera.columns()),
            rows: index(camera.rows()),
        }
    }

    /// Returns the number of regions of a frame.
    pub(crate) fn regions(&self) -> usize {
        self.columns * self.rows
    }

    /// Returns the width and height of the padded frame in pixels.
    pub(crate) fn padded(&self) -> (usize, usize) {
        (self.columns * self.side, self.rows * self.side)
    }

    /// Returns the numbers of the regions that row `y` of the padded frame crosses, from left to
    /// right.
    pub(crate) fn across(&self, y: usize) -> Range<usize> {
        let first = y / self.side * self.columns;
        first..first + self.columns
    }

    /// Returns the columns and rows of a region in the padded frame.
    pub(crate) fn area(&self, region: usize) -> (Range<usize>, Range<usize>) {
        let (left, top) = (region % self.columns * self.side, region / self.columns * self.side);
        (left..left + self.side, top..top + self.side)
    }

    /// Returns the columns and rows of a region without padding.
    pub(crate) fn seen(&self, region: usize) -> (Range<usize>, Range<usize>) {
        let (columns, rows) = self.area(region);
        (columns.start..columns.end.min(self.width), rows.start..rows.end.min(self.height))
    }
}

/// Converts a size to an index. It loses nothing, because `usize` has at least 32 bits on every
/// platform that can hold a frame.
pub(crate) const fn index(value: u32) -> usize {
    value as usize
}
