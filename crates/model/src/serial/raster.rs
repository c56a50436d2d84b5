// SPDX-License-Identifier: MIT OR Apache-2.0
//! `feed = "raster"`: the padded frame, pixel by pixel; the array finds the regions that want each.

use foveate_design::SerialDesign;

use crate::number::index;

/// The pixels of a padded frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Raster {
    columns: Axis,
    rows: Axis,
    pixels: Vec<u16>,
}

/// One of the two directions of a frame.
#[derive(Clone, Debug, PartialEq)]
struct Axis {
    /// Regions side by side.
    regions: usize,
    /// Side of a region N.
    side: usize,
    /// Its halo r.
    halo: usize,
    /// For every place: how many places of the windows show it, c of `docs/serial.md`.
    shown: Vec<u32>,
}

impl Axis {
    fn new(design: SerialDesign<'_>, regions: u32, shown: impl Fn(u32) -> u32) -> Self {
        let side = design.region_size();
        Self {
            regions: index(regions),
            side: index(side),
            halo: index(design.halo()),
            shown: (0..regions * side).map(shown).collect(),
        }
    }

    fn size(&self) -> usize {
        self.regions * self.side
    }

    /// The places that the window of a region shows; the frame's border repeats.
    fn window(&self, region: usize) -> impl Iterator<Item = usize> + use<> {
        let (first, halo, last) = (region * self.side, self.halo, self.size() - 1);
        (first..first + self.side + 2 * halo).map(move |at| at.saturating_sub(halo).min(last))
    }
}

impl Raster {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let columns = Axis::new(design, design.columns(), |x| design.column_places(x));
        let rows = Axis::new(design, design.rows(), |y| design.row_places(y));
        Self { pixels: vec![0; columns.size() * rows.size()], columns, rows }
    }

    /// Pixels of a frame.
    pub(super) fn pixels(&self) -> usize {
        self.pixels.len()
    }

    /// Takes pixel number `at` of the frame; says how many places want it.
    pub(super) fn write(&mut self, at: usize, pixel: u16) -> u64 {
        self.pixels[at] = pixel;
        self.clocks(at)
    }

    /// For how many clocks the pixels of a frame are written, from number `at` on.
    pub(super) fn clocks_from(&self, at: usize) -> u64 {
        (at..self.pixels.len()).map(|at| self.clocks(at)).sum()
    }

    /// For how many clocks pixel number `at` of the frame is written.
    fn clocks(&self, at: usize) -> u64 {
        let width = self.columns.size();
        u64::from(self.columns.shown[at % width]) * u64::from(self.rows.shown[at / width])
    }

    pub(super) fn stream(&self, region: usize, out: &mut Vec<u16>) {
        let (column, row) = self.place(region);
        for y in self.rows.window(row) {
            let line = &self.pixels[y * self.columns.size()..];
            out.extend(self.columns.window(column).map(|x| line[x]));
        }
    }

    /// Column and row of a region.
    fn place(&self, region: usize) -> (usize, usize) {
        (region % self.columns.regions, region / self.columns.regions)
    }
}
