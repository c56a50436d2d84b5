// SPDX-License-Identifier: MIT OR Apache-2.0
//! What there is to see of a frame: what stands in its regions now, and what stood there before. Every score takes
//! this, so that a new one can look at all of it.

use crate::grid::Grid;
use crate::plane::Plane;

/// What there is to see of a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameView<'a> {
    pub(crate) grid: &'a Grid,
    /// The denoised frame.
    pub(crate) now: &'a Plane,
    /// What its regions are compared with.
    pub(crate) before: &'a References,
}

/// The reference of every region.
#[derive(Clone, Debug)]
pub(crate) struct References {
    /// Their pixels, in their places; nothing is repeated around them.
    pub(crate) plane: Plane,
    /// Which regions have a valid one.
    pub(crate) valid: Vec<bool>,
}
