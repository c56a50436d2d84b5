// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a frame is compared with: the denoised pixels of every region as they once were.

use foveate_camera::Action;
use foveate_camera::{Camera, Reference};

use crate::feature::add_up;
use crate::grid::Grid;
use crate::plane::Plane;

/// The reference of every region.
#[derive(Clone, Debug)]
pub(crate) struct Memory {
    kind: Reference,
    level: f64,
    plane: Plane,
    valid: Vec<bool>,
    line: Vec<f64>,
}

impl Memory {
    /// Of a camera that has seen nothing.
    pub(crate) fn new(camera: &Camera, grid: &Grid) -> Self {
        Self {
            kind: camera.temporal().reference,
            level: f64::from(camera.temporal().level),
            plane: Plane::black(grid),
            valid: vec![false; grid.regions()],
            line: vec![0.0; grid.padded().0],
        }
    }

    pub(crate) fn forget(&mut self) {
        self.valid.fill(false);
    }

    /// Changed pixels of every region; all of them where there is no valid reference.
    pub(crate) fn compare(&mut self, now: &Plane, grid: &Grid, all: f64, changed: &mut [f64]) {
        changed.fill(0.0);
        for y in 0..now.height() {
            let pairs = now.row(y).iter().zip(self.plane.row(y));
            for (hit, (now, then)) in self.line.iter_mut().zip(pairs) {
                *hit = if (now - then).abs() > self.level { 1.0 } else { 0.0 };
            }
            add_up(&self.line, grid.side, &mut changed[grid.across(y)]);
        }
        for (changed, valid) in changed.iter_mut().zip(&self.valid) {
            if !valid {
                *changed = all;
            }
        }
    }

    /// Takes what the next frame will be compared with.
    pub(crate) fn keep(&mut self, now: &Plane, grid: &Grid, region: usize, action: Action) {
        match (self.kind, action) {
            (Reference::Previous, _) | (Reference::LastSent, Action::Forward) => {
                let (columns, rows) = grid.area(region);
                for y in rows {
                    self.plane.row_mut(y)[columns.clone()]
                        .copy_from_slice(&now.row(y)[columns.clone()]);
                }
                self.valid[region] = true;
            }
            (Reference::LastSent, Action::Hold) => {}
            // What was sent is no longer on the screen.
            (Reference::LastSent, Action::Blank) => self.valid[region] = false,
        }
    }
}
