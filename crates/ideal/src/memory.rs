// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a frame is compared with: the denoised pixels of every region as they once were.

use foveate_camera::Action;
use foveate_camera::{Camera, Reference};

use crate::grid::Grid;
use crate::plane::Plane;
use crate::view::{FrameView, References};

/// Keeps the reference of every region.
#[derive(Clone, Debug)]
pub(crate) struct Memory {
    kind: Reference,
    references: References,
}

impl Memory {
    /// Of a camera that has seen nothing.
    pub(crate) fn new(camera: &Camera, grid: &Grid) -> Self {
        Self {
            kind: camera.temporal().reference,
            references: References {
                plane: Plane::black(grid),
                valid: vec![false; grid.regions()],
            },
        }
    }

    pub(crate) fn forget(&mut self) {
        self.references.valid.fill(false);
    }

    /// A frame beside what its regions are compared with.
    pub(crate) fn before<'a>(&'a self, now: &'a Plane, grid: &'a Grid) -> FrameView<'a> {
        FrameView { grid, now, before: &self.references }
    }

    /// Takes what the next frame will be compared with.
    pub(crate) fn keep(&mut self, now: &Plane, grid: &Grid, region: usize, action: Action) {
        let References { plane, valid } = &mut self.references;
        match (self.kind, action) {
            (Reference::Previous, _) | (Reference::LastSent, Action::Forward) => {
                let (columns, rows) = grid.area(region);
                for y in rows {
                    plane.row_mut(y)[columns.clone()].copy_from_slice(&now.row(y)[columns.clone()]);
                }
                valid[region] = true;
            }
            (Reference::LastSent, Action::Hold) => {}
            // What was sent is no longer on the screen.
            (Reference::LastSent, Action::Blank | Action::Summarize) => valid[region] = false,
        }
    }
}
