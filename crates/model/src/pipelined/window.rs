// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window stage of either kind, and how a window is taken out of the pixels that a stage keeps.

use foveate_design::Neighborhood;

use super::isolated::IsolatedWindow;
use super::pixel::Pixel;
use super::plan::Plan;
use super::shared::SharedWindow;
use crate::window::Window;

/// What a window stage gives at a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Center {
    /// The pixel at the center.
    pub(super) pixel: Pixel,
    /// The scored values around it.
    pub(super) window: Window,
}

/// A 3x3 window that slides over a region.
#[derive(Clone, Debug)]
pub(super) enum WindowStage {
    Isolated(IsolatedWindow),
    Shared(SharedWindow),
}

impl WindowStage {
    /// A window on a square of `side` pixels.
    pub(super) fn new(plan: &Plan, side: usize) -> Self {
        match plan.neighborhood {
            Neighborhood::Isolated => Self::Isolated(IsolatedWindow::new(side)),
            Neighborhood::Shared => Self::Shared(SharedWindow::new(side)),
        }
    }

    /// One edge. `border` names the sides beyond which a shared window repeats its region's pixels.
    pub(super) fn step(&mut self, pixel: Option<Pixel>, border: u8) -> Option<Center> {
        match self {
            Self::Isolated(window) => window.step(pixel),
            Self::Shared(window) => window.step(pixel, border),
        }
    }

    pub(super) fn reset(&mut self) {
        match self {
            Self::Isolated(window) => window.reset(),
            Self::Shared(window) => window.reset(),
        }
    }
}

/// The window at column `x` and row `y` of a square of pixels, where no position is below `low` or
/// above `high` (column, row).
pub(super) fn center_at(
    pixels: &[Pixel],
    side: usize,
    (x, y): (usize, usize),
    low: (usize, usize),
    high: (usize, usize),
) -> Center {
    let columns = [x.saturating_sub(1).max(low.0), x, (x + 1).min(high.0)];
    let rows = [y.saturating_sub(1).max(low.1), y, (y + 1).min(high.1)];
    let mut window = [0; 9];
    for (line, row) in window.chunks_exact_mut(3).zip(rows) {
        for (value, column) in line.iter_mut().zip(columns) {
            *value = pixels[row * side + column].scored;
        }
    }
    Center { pixel: pixels[y * side + x], window }
}
