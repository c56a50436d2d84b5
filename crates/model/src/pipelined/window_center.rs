// SPDX-License-Identifier: MIT OR Apache-2.0
//! The output of a window stage, and its extraction from the pixels that the stage stores.

use super::pixel::StagePixel;
use crate::window::PixelWindow;

/// The output of a window stage at a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct WindowCenter {
    /// The pixel at the center.
    pub(super) pixel: StagePixel,
    /// The scored values of the window around the center.
    pub(super) window: PixelWindow,
}

/// Returns the window at column `x` and row `y` of a square of pixels. Positions below `low` or
/// above `high` (column, row) are moved to the nearest position inside.
pub(super) fn center_at(
    pixels: &[StagePixel],
    side: usize,
    (x, y): (usize, usize),
    low: (usize, usize),
    high: (usize, usize),
) -> WindowCenter {
    let columns = [x.saturating_sub(1).max(low.0), x, (x + 1).min(high.0)];
    let rows = [y.saturating_sub(1).max(low.1), y, (y + 1).min(high.1)];
    let mut window = [0; 9];
    for (line, row) in window.chunks_exact_mut(3).zip(rows) {
        for (value, column) in line.iter_mut().zip(columns) {
            *value = pixels[row * side + column].scored;
        }
    }
    WindowCenter { pixel: pixels[y * side + x], window }
}
