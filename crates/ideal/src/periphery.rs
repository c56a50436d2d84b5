// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summaries of irrelevant regions: the real means of their blocks, each as the nearest grey level. What leaves a camera
//! are pixels of P bits here, too, so no summary is sent or left out by rounding.

use std::ops::Range;

use foveate_camera::{Action, Camera};

use crate::grid::{Grid, index};
use crate::plane::Plane;

/// How summaries are formed, and what every region has sent of itself last.
#[derive(Clone, Debug)]
pub(crate) struct Periphery {
    blocks: usize,
    side: usize,
    level: f64,
    /// By region, while the screen shows it: the means of its blocks, row by row.
    shown: Vec<Option<Vec<f64>>>,
}

impl Periphery {
    /// That of a camera, if it has one.
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

    /// The means of a region's blocks.
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

    /// Whether these means are to be sent.
    pub(crate) fn is_due(&self, region: usize, means: &[f64]) -> bool {
        self.shown[region].as_ref().is_none_or(|shown| {
            shown.iter().zip(means).any(|(shown, mean)| (shown - mean).abs() > self.level)
        })
    }

    /// What the screen shows of a region behind an action.
    pub(crate) fn follow(&mut self, region: usize, action: Action, means: Vec<f64>) {
        match action {
            Action::Forward => self.shown[region] = None,
            Action::Summarize => self.shown[region] = Some(means),
            Action::Hold | Action::Blank => {}
        }
    }

    /// The value that the screen shows at a place of a region whose summary it shows.
    pub(crate) fn value(&self, grid: &Grid, region: usize, (x, y): (usize, usize)) -> f64 {
        let (columns, rows) = grid.area(region);
        let block = (y - rows.start) / self.side * self.blocks + (x - columns.start) / self.side;
        self.shown[region].as_ref().map_or(0.0, |means| means[block])
    }
}
