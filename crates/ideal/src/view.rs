// SPDX-License-Identifier: MIT OR Apache-2.0
//! The view of a frame that every score gets: the denoised pixels, and the references of the
//! regions. A new score can use all of it.

use crate::grid::Grid;
use crate::plane::Plane;

/// A denoised frame and the references that it is compared with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameView<'a> {
    pub(crate) grid: &'a Grid,
    /// The denoised frame.
    pub(crate) now: &'a Plane,
    /// The references of the frame's regions.
    pub(crate) before: &'a References,
}

/// The reference of every region.
#[derive(Clone, Debug)]
pub(crate) struct References {
    /// The pixels of the references at the positions of their regions; the border is not filled.
    pub(crate) plane: Plane,
    /// Whether each region has a valid reference.
    pub(crate) valid: Vec<bool>,
}
