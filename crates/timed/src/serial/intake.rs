// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks that taking a frame needs: one for each pixel, or one for each place in the lanes
//! where a pixel of a raster feed is stored.

use foveate_design::{PixelFeed, SerialDesign};

/// The clocks of the pixels of a frame.
#[derive(Debug)]
pub(super) enum IntakeClocks {
    /// Each pixel takes a clock. The number is that of the pixels of a frame.
    Parallel(u64),
    /// A pixel (x, y) takes c(x) * c(y) clocks. The lists have the sums of c up to each column or
    /// row, and a last element for all.
    Raster { columns: Vec<u64>, rows: Vec<u64> },
}

impl IntakeClocks {
    pub(super) fn new(design: SerialDesign<'_>, pixels: u64) -> Self {
        match design.feed() {
            PixelFeed::Parallel => Self::Parallel(pixels),
            PixelFeed::Raster => {
                let (width, height) = (design.columns(), design.rows());
                let side = design.region_size();
                Self::Raster {
                    columns: sums((0..width * side).map(|x| design.column_places(x))),
                    rows: sums((0..height * side).map(|y| design.row_places(y))),
                }
            }
        }
    }

    /// Returns the clocks from the first pixel of a frame to pixel number `pixel`, if the source
    /// never pauses.
    pub(super) fn place(&self, pixel: u64) -> u64 {
        match self {
            Self::Parallel(_) => pixel,
            Self::Raster { columns, rows } => {
                let width = columns.len() - 1;
                let pixel = usize::try_from(pixel).expect("a pixel of the frame");
                let (x, y) = (pixel % width, pixel / width);
                rows[y] * columns[width] + (rows[y + 1] - rows[y]) * columns[x]
            }
        }
    }

    /// Returns the clocks that the whole frame needs, U'.
    pub(super) fn clocks(&self) -> u64 {
        match self {
            Self::Parallel(pixels) => *pixels,
            Self::Raster { columns, rows } => columns[columns.len() - 1] * rows[rows.len() - 1],
        }
    }
}

/// Returns the sums of the numbers before each of them, and that of all.
fn sums(counts: impl Iterator<Item = u32>) -> Vec<u64> {
    let mut sum = 0;
    let rest = counts.map(|count| {
        sum += u64::from(count);
        sum
    });
    std::iter::once(0).chain(rest).collect()
}
