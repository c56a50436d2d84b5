// SPDX-License-Identifier: MIT OR Apache-2.0
//! The buffer of `feed = "raster"`: the padded frame, pixel by pixel, from which the array makes
//! the streams of all regions.

use foveate_design::SerialDesign;

use crate::conversions::index;

/// The pixels of a padded frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RasterFeedFrame {
    columns: GridAxis,
    rows: GridAxis,
    pixels: Vec<u16>,
}

/// One of the two axes of the grid of regions.
#[derive(Clone, Debug, PartialEq)]
struct GridAxis {
    /// Number of regions along the axis.
    regions: usize,
    /// Side of a region N in pixels.
    side: usize,
    /// Halo of a region r in pixels.
    halo: usize,
    /// For every coordinate, the number of positions in windows that show it: c of
    /// `docs/serial.md`.
    place_counts: Vec<u32>,
}

impl GridAxis {
    fn new(design: SerialDesign<'_>, regions: u32, shown: impl Fn(u32) -> u32) -> Self {
        let side = design.region_size();
        Self {
            regions: index(regions),
            side: index(side),
            halo: index(design.halo()),
            place_counts: (0..regions * side).map(shown).collect(),
        }
    }

    fn size(&self) -> usize {
        self.regions * self.side
    }

    /// Returns the coordinates that the window of a region shows. The border of the frame is
    /// repeated.
    fn window_coordinates(&self, region: usize) -> impl Iterator<Item = usize> + use<> {
        let (first, halo, last) = (region * self.side, self.halo, self.size() - 1);
        (first..first + self.side + 2 * halo).map(move |at| at.saturating_sub(halo).min(last))
    }
}

impl RasterFeedFrame {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let columns = GridAxis::new(design, design.columns(), |x| design.column_places(x));
        let rows = GridAxis::new(design, design.rows(), |y| design.row_places(y));
        Self { pixels: vec![0; columns.size() * rows.size()], columns, rows }
    }

    /// Returns the number of pixels of a frame.
    pub(super) fn pixels(&self) -> usize {
        self.pixels.len()
    }

    /// Writes pixel number `at` of the frame, and returns the number of places where the array
    /// stores it.
    pub(super) fn write(&mut self, at: usize, pixel: u16) -> u64 {
        self.pixels[at] = pixel;
        self.clocks(at)
    }

    /// Returns the number of clocks for which the pixels from number `at` on are written.
    pub(super) fn clocks_from(&self, at: usize) -> u64 {
        (at..self.pixels.len()).map(|at| self.clocks(at)).sum()
    }

    /// Returns the number of clocks for which pixel number `at` is written.
    fn clocks(&self, at: usize) -> u64 {
        let width = self.columns.size();
        u64::from(self.columns.place_counts[at % width])
            * u64::from(self.rows.place_counts[at / width])
    }

    pub(super) fn stream(&self, region: usize, out: &mut Vec<u16>) {
        let (column, row) = self.place(region);
        for y in self.rows.window_coordinates(row) {
            let line = &self.pixels[y * self.columns.size()..];
            out.extend(self.columns.window_coordinates(column).map(|x| line[x]));
        }
    }

    /// Returns the column and the row of a region in the grid.
    fn place(&self, region: usize) -> (usize, usize) {
        (region % self.columns.regions, region / self.columns.regions)
    }
}
