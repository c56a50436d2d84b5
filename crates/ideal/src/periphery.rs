// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summaries of irrelevant regions, which are the real means of their blocks, each rounded to
//! the nearest grey level. The means are rounded because the ideal camera sends values of P bits,
//! as every camera does.

use std::ops::Range;

use foveate_camera::{Camera, RegionAction};

use super::plane::{RegionGrid, to_index};
use crate::plane::PaddedPlane;

/// The blocks of a periphery, and the summary that the screen shows of every region.
#[derive(Clone, Debug)]
pub(crate) struct PeripheryState {
    blocks: usize,
    side: usize,
    /// The means of the blocks of every region, row by row; `None` while the screen shows no
    /// summary of the region.
    shown_means: Vec<Option<Vec<f64>>>,
}

impl PeripheryState {
    /// Creates the periphery of a camera; `None` if the camera has no periphery.
    pub(crate) fn from_camera(camera: &Camera, grid: &RegionGrid) -> Option<Self> {
        camera.periphery().map(|periphery| Self {
            blocks: to_index(periphery.blocks),
            side: to_index(periphery.block_side),
            shown_means: vec![None; grid.regions()],
        })
    }

    pub(crate) fn forget(&mut self) {
        self.shown_means.fill(None);
    }

    /// Returns the means of a region's blocks.
    pub(crate) fn means(
        &self,
        payload: &PaddedPlane,
        grid: &RegionGrid,
        region: usize,
    ) -> Vec<f64> {
        let (columns, rows) = grid.area(region);
        let starts = |along: Range<usize>| along.step_by(self.side);
        let blocks =
            starts(rows).flat_map(|top| starts(columns.clone()).map(move |left| (left, top)));
        blocks.map(|(left, top)| self.mean(payload, left, top)).collect()
    }

    fn mean(&self, payload: &PaddedPlane, left: usize, top: usize) -> f64 {
        let rows = (top..top + self.side).map(|y| &payload.row(y)[left..left + self.side]);
        let (sum, count) =
            rows.flatten().fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
        (sum / count + 0.5_f64).floor()
    }

    /// Returns whether these means differ by more than `level` from the shown ones, so that they
    /// must be sent.
    pub(crate) fn is_due(&self, region: usize, means: &[f64], level: f64) -> bool {
        self.shown_means[region].as_ref().is_none_or(|shown| {
            shown.iter().zip(means).any(|(shown, mean)| (shown - mean).abs() > level)
        })
    }

    /// Updates the summary that the screen shows of a region after an action.
    pub(crate) fn apply_action(&mut self, region: usize, action: RegionAction, means: Vec<f64>) {
        match action {
            RegionAction::Forward => self.shown_means[region] = None,
            RegionAction::Summarize => self.shown_means[region] = Some(means),
            RegionAction::Hold | RegionAction::Blank => {}
        }
    }

    /// Returns the value that the screen shows at a pixel of a region whose summary it shows.
    pub(crate) fn shown_value(
        &self,
        grid: &RegionGrid,
        region: usize,
        (x, y): (usize, usize),
    ) -> f64 {
        let (columns, rows) = grid.area(region);
        let block = (y - rows.start) / self.side * self.blocks + (x - columns.start) / self.side;
        self.shown_means[region].as_ref().map_or(0.0, |means| means[block])
    }
}
