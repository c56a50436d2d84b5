// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window stage for either neighborhood.

use foveate_camera::Neighborhood;

use super::isolated_window::IsolatedWindow;
use super::pixel::StagePixel;
use super::rpu_parameters::RpuParameters;
use super::shared_window::SharedWindow;
use super::window_center::WindowCenters;

/// A stage with a 3x3 window in every lane, which moves over the region of the lane.
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

    /// Applies one edge. `pixels` has a pixel per lane. `borders` has, for each lane, the sides
    /// beyond which a shared window repeats pixels of its region, if there are any.
    pub(super) fn step<'a>(
        &'a mut self,
        pixels: Option<Vec<StagePixel>>,
        borders: Option<&'a [u8]>,
    ) -> Option<WindowCenters<'a>> {
        match self {
            Self::Isolated(window) => window.step(pixels),
            Self::Shared(window) => window.step(pixels, borders),
        }
    }

    pub(super) fn reset(&mut self) {
        match self {
            Self::Isolated(window) => window.reset(),
            Self::Shared(window) => window.reset(),
        }
    }
}
