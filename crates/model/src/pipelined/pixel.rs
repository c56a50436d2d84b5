// SPDX-License-Identifier: MIT OR Apache-2.0
//! The values that travel between the stages.

use super::plan::FEATURES;

/// A pixel with its scored and its raw value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pixel {
    /// The value that is scored: denoised if the design has a filter.
    pub(super) scored: u16,
    /// The value of the input stream.
    pub(super) raw: u16,
}

impl Pixel {
    /// Makes a pixel of a value of the input stream.
    pub(super) fn incoming(value: u16) -> Self {
        Self { scored: value, raw: value }
    }
}

/// A step of the last window: a pixel and, by number of the feature, true if it is a hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Step {
    pub(super) pixel: Pixel,
    pub(super) hits: [bool; FEATURES],
}
