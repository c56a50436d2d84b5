// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a frame is cut into regions.

use std::ops::Range;

use foveate_camera::Camera;

/// Sizes in pixels and numbers of regions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// Frame width without padding.
    pub(crate) width: usize,
    /// Frame height without padding.
    pub(crate) height: usize,
    /// Side of a region.
    pub(crate) side: usize,
    /// Regions side by side.
    pub(crate) columns: usize,
    /// Regions one below the other.
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

    /// Regions of a frame.
    pub(crate) fn regions(&self) -> usize {
        self.columns * self.rows
    }

    /// Width and height of a whole number of regions.
    pub(crate) fn padded(&self) -> (usize, usize) {
        (self.columns * self.side, self.rows * self.side)
    }

    /// Numbers of the regions that row `y` of the padded frame goes through, from left to right.
    pub(crate) fn across(&self, y: usize) -> Range<usize> {
        let first = y / self.side * self.columns;
        first..first + self.columns
    }

    /// Columns and rows of one region in the padded frame.
    pub(crate) fn area(&self, region: usize) -> (Range<usize>, Range<usize>) {
        let (left, top) = (region % self.columns * self.side, region / self.columns * self.side);
        (left..left + self.side, top..top + self.side)
    }

    /// The part of an area that is not padding.
    pub(crate) fn seen(&self, region: usize) -> (Range<usize>, Range<usize>) {
        let (columns, rows) = self.area(region);
        (columns.start..columns.end.min(self.width), rows.start..rows.end.min(self.height))
    }
}

/// A size as an index. Lossless: `usize` has 32 bits or more on every platform that can hold a frame.
pub(crate) const fn index(value: u32) -> usize {
    value as usize
}
