// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window stage for either neighborhood.

use foveate_design::Neighborhood;

use super::isolated_window::IsolatedWindow;
use super::pixel::StagePixel;
use super::rpu_parameters::RpuParameters;
use super::shared_window::SharedWindow;
use super::window_center::WindowCenter;

/// A stage with a 3x3 window that moves over a region.
#[derive(Clone, Debug)]
pub(super) enum WindowStage {
    Isolated(IsolatedWindow),
    Shared(SharedWindow),
}

impl WindowStage {
    /// Makes a window stage for a square of `side` pixels.
    pub(super) fn new(plan: &RpuParameters, side: usize) -> Self {
        match plan.neighborhood {
            Neighborhood::Isolated => Self::Isolated(IsolatedWindow::new(side)),
            Neighborhood::Shared => Self::Shared(SharedWindow::new(side)),
        }
    }

    /// Applies one edge. `border` has the sides beyond which a shared window repeats pixels of its
    /// region.
    pub(super) fn step(&mut self, pixel: Option<StagePixel>, border: u8) -> Option<WindowCenter> {
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
