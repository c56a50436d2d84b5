// SPDX-License-Identifier: MIT OR Apache-2.0
//! The view of a frame that every score gets: the denoised pixels, and the references of the
//! regions. A new score can use all of it.

use super::plane::RegionGrid;
use crate::plane::PaddedPlane;

/// A denoised frame and the references that it is compared with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameView<'a> {
    pub(crate) grid: &'a RegionGrid,
    pub(crate) denoised: &'a PaddedPlane,
    /// The references of the frame's regions.
    pub(crate) references: &'a RegionReferences,
}

#[derive(Clone, Debug)]
pub(crate) struct RegionReferences {
    /// The pixels of the references at the positions of their regions; the border is not filled.
    pub(crate) plane: PaddedPlane,
    pub(crate) valid: Vec<bool>,
}
