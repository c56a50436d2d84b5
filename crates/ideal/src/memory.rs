// SPDX-License-Identifier: MIT OR Apache-2.0
//! The references that a frame is compared with: the denoised pixels of every region in an earlier
//! frame.

use foveate_camera::{Camera, ReferencePolicy, RegionAction};

use super::plane::RegionGrid;
use crate::plane::PaddedPlane;
use crate::view::{FrameView, RegionReferences};

/// The memory of the references of all regions.
#[derive(Clone, Debug)]
pub(crate) struct ReferenceMemory {
    kind: ReferencePolicy,
    references: RegionReferences,
}

impl ReferenceMemory {
    /// Creates the memory of a camera before its first frame: no reference is valid.
    pub(crate) fn new(camera: &Camera, grid: &RegionGrid) -> Self {
        Self {
            kind: camera.temporal().reference,
            references: RegionReferences {
                plane: PaddedPlane::black(grid),
                valid: vec![false; grid.regions()],
            },
        }
    }

    pub(crate) fn forget(&mut self) {
        self.references.valid.fill(false);
    }

    /// Pairs a frame with the references of its regions.
    pub(crate) fn frame_view<'a>(
        &'a self,
        denoised: &'a PaddedPlane,
        grid: &'a RegionGrid,
    ) -> FrameView<'a> {
        FrameView { grid, denoised, references: &self.references }
    }

    /// Updates the reference of a region for the next frame.
    pub(crate) fn update_reference(
        &mut self,
        denoised: &PaddedPlane,
        grid: &RegionGrid,
        region: usize,
        action: RegionAction,
    ) {
        let RegionReferences { plane, valid } = &mut self.references;
        match (self.kind, action) {
            (ReferencePolicy::Previous, _) | (ReferencePolicy::LastSent, RegionAction::Forward) => {
                let (columns, rows) = grid.area(region);
                for y in rows {
                    plane.row_mut(y)[columns.clone()]
                        .copy_from_slice(&denoised.row(y)[columns.clone()]);
                }
                valid[region] = true;
            }
            (ReferencePolicy::LastSent, RegionAction::Hold) => {}
            // The screen no longer shows the pixels that were sent.
            (ReferencePolicy::LastSent, RegionAction::Blank | RegionAction::Summarize) => {
                valid[region] = false;
            }
        }
    }
}
