// SPDX-License-Identifier: MIT OR Apache-2.0
//! The values that travel between the stages.

use foveate_camera::RegionClass;

use super::rpu_parameters::MAX_FEATURES;
use crate::feature::surface::WindowDifferences;

/// A pixel with its scored and its raw value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct StagePixel {
    /// The value that is scored: denoised if the design has a filter.
    pub(super) scored: u16,
    /// The value of the input stream.
    pub(super) raw: u16,
}

impl StagePixel {
    /// Makes a pixel of a value of the input stream.
    pub(super) fn from_input(value: u16) -> Self {
        Self { scored: value, raw: value }
    }
}

/// A step of the last window: a pixel, its differences from neighbors and, by number of the
/// feature, true if it is a hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TailStep {
    pub(super) pixel: StagePixel,
    pub(super) hits: [bool; MAX_FEATURES],
    /// The class of the region in the frame of the pixel.
    pub(super) class: RegionClass,
    /// The differences for `surface`; zeros in a design without it.
    pub(super) differences: WindowDifferences,
}
