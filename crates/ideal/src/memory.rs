// SPDX-License-Identifier: MIT OR Apache-2.0
//! The references that a frame is compared with: the denoised pixels of every region in an earlier
//! frame.

use foveate_camera::Action;
use foveate_camera::{Camera, Reference};

use crate::grid::Grid;
use crate::plane::Plane;
use crate::view::{FrameView, References};

/// The memory of the references of all regions.
#[derive(Clone, Debug)]
pub(crate) struct Memory {
    kind: Reference,
    references: References,
}

impl Memory {
    /// Creates the memory of a camera before its first frame: no reference is valid.
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

    /// Pairs a frame with the references of its regions.
    pub(crate) fn before<'a>(&'a self, now: &'a Plane, grid: &'a Grid) -> FrameView<'a> {
        FrameView { grid, now, before: &self.references }
    }

    /// Updates the reference of a region for the next frame.
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
            // The screen no longer shows the pixels that were sent.
            (Reference::LastSent, Action::Blank | Action::Summarize) => valid[region] = false,
        }
    }
}
