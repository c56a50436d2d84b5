// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summaries of irrelevant regions: the real means of their blocks, each rounded to the nearest
//! grey level. An ideal camera also sends values of P bits, so its decision to send a summary does
//! not depend on rounding in hardware.

use std::ops::Range;

use foveate_camera::{Action, Camera};

use crate::grid::{Grid, index};
use crate::plane::Plane;

/// The blocks of a periphery, and the summary that the screen shows of every region.
#[derive(Clone, Debug)]
pub(crate) struct Periphery {
    blocks: usize,
    side: usize,
    level: f64,
    /// The means of the blocks of every region, row by row; `None` while the screen shows no
    /// summary of the region.
    shown: Vec<Option<Vec<f64>>>,
}

impl Periphery {
    /// Creates the periphery of a camera; `None` if the camera has no periphery.
    pub(crate) fn of(camera: &Camera, grid: &Grid) -> Option<Self> {
        camera.periphery().map(|own| Self {
            blocks: index(own.blocks),
            side: index(own.block_side),
            level: own.level.into(),
            shown: vec![None; grid.regions()],
        })
    }

    pub(crate) fn forget(&mut self) {
        self.shown.fill(None);
    }

    /// Returns the means of a region's blocks.
    pub(crate) fn means(&self, payload: &Plane, grid: &Grid, region: usize) -> Vec<f64> {
        let (columns, rows) = grid.area(region);
        let starts = |along: Range<usize>| along.step_by(self.side);
        let blocks =
            starts(rows).flat_map(|top| starts(columns.clone()).map(move |left| (left, top)));
        blocks.map(|(left, top)| self.mean(payload, left, top)).collect()
    }

    fn mean(&self, payload: &Plane, left: usize, top: usize) -> f64 {
        let rows = (top..top + self.side).map(|y| &payload.row(y)[left..left + self.side]);
        let (sum, count) =
            rows.flatten().fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
        (sum / count + 0.5_f64).floor()
    }

    /// Returns whether these means differ so much from the shown ones that they must be sent.
    pub(crate) fn is_due(&self, region: usize, means: &[f64]) -> bool {
        self.shown[region].as_ref().is_none_or(|shown| {
            shown.iter().zip(means).any(|(shown, mean)| (shown - mean).abs() > self.level)
        })
    }

    /// Updates the summary that the screen shows of a region after an action.
    pub(crate) fn follow(&mut self, region: usize, action: Action, means: Vec<f64>) {
        match action {
            Action::Forward => self.shown[region] = None,
            Action::Summarize => self.shown[region] = Some(means),
            Action::Hold | Action::Blank => {}
        }
    }

    /// Returns the value that the screen shows at a pixel of a region whose summary it shows.
    pub(crate) fn value(&self, grid: &Grid, region: usize, (x, y): (usize, usize)) -> f64 {
        let (columns, rows) = grid.area(region);
        let block = (y - rows.start) / self.side * self.blocks + (x - columns.start) / self.side;
        self.shown[region].as_ref().map_or(0.0, |means| means[block])
    }
}
