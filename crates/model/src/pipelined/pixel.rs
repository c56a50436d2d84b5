// SPDX-License-Identifier: MIT OR Apache-2.0
//! What travels between the stages.

use super::plan::FEATURES;

/// One pixel with the two values that it may have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pixel {
    /// The value that is scored: denoised where the design denoises.
    pub(super) scored: u16,
    /// The value that came in.
    pub(super) raw: u16,
}

impl Pixel {
    /// A pixel of the input stream.
    pub(super) fn incoming(value: u16) -> Self {
        Self { scored: value, raw: value }
    }
}

/// A step of the last window: a pixel and, by number of the feature, whether it is a hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Step {
    pub(super) pixel: Pixel,
    pub(super) hits: [bool; FEATURES],
}
