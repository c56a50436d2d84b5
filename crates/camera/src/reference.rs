// SPDX-License-Identifier: MIT OR Apache-2.0
//! The demands of a reference on the hardware that stores it. A new reference must be added to
//! every match here. Each implementation of the camera defines what it computes with the reference.

use crate::ReferencePolicy;

/// The time at which the reference of a region is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceWriteTime {
    /// The reference is written with every frame, whatever the decision for the region is.
    EveryFrame,
    /// The reference is written when pixels of the region leave, and at no other time.
    WhenSent,
}

impl ReferencePolicy {
    /// Returns the time at which the reference of a region is written.
    #[must_use]
    pub fn write_time(self) -> ReferenceWriteTime {
        match self {
            Self::Previous => ReferenceWriteTime::EveryFrame,
            Self::LastSent => ReferenceWriteTime::WhenSent,
        }
    }

    /// Returns true if, in a sequence of equal frames, scores and decisions do not change any more
    /// from the second frame on.
    #[must_use]
    pub fn is_stable_on_equal_frames(self) -> bool {
        match self {
            // Both references hold the same pixels as the new frame.
            Self::Previous | Self::LastSent => true,
        }
    }

    /// Returns the bits of state per pixel, for pixels of `pixel_bits` bits.
    #[must_use]
    pub fn bits_per_pixel(self, pixel_bits: u32) -> u32 {
        match self {
            Self::Previous | Self::LastSent => pixel_bits,
        }
    }

    /// Returns the bits of state per region in addition to its pixels: one if regions differ in
    /// whether they have a valid reference, else 0.
    #[must_use]
    pub fn bits_per_region(self) -> u32 {
        match self {
            Self::Previous => 0,
            Self::LastSent => 1,
        }
    }

    /// Returns true if a region whose pixels are lost on their way out has no valid reference any
    /// more.
    #[must_use]
    pub fn is_lost_with_its_region(self) -> bool {
        match self {
            Self::Previous => false,
            Self::LastSent => true,
        }
    }
}
