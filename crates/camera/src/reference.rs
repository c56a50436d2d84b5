// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a reference asks of the hardware that keeps it. A new one answers here first; what is computed with it each
//! implementation says for itself.

use crate::Reference;

/// When the reference of a region is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    /// With every frame, whatever becomes of the region.
    WithEveryFrame,
    /// When pixels of the region leave, and at no other time.
    WhenSent,
}

impl Reference {
    /// When it is written.
    #[must_use]
    pub fn written(self) -> Written {
        match self {
            Self::Previous => Written::WithEveryFrame,
            Self::LastSent => Written::WhenSent,
        }
    }

    /// Whether it stays as it is from the second of equal frames on, so that no score or decision changes any more.
    #[must_use]
    pub fn settles(self) -> bool {
        match self {
            // Equal frames are the same reference, and what is sent is what there was.
            Self::Previous | Self::LastSent => true,
        }
    }

    /// Bits of state per pixel, of `pixel_bits` bits.
    #[must_use]
    pub fn bits_per_pixel(self, pixel_bits: u32) -> u32 {
        match self {
            Self::Previous | Self::LastSent => pixel_bits,
        }
    }

    /// Bits of state per region beside its pixels: whether it has a reference, where that is not the same for all.
    #[must_use]
    pub fn bits_per_region(self) -> u32 {
        match self {
            Self::Previous => 0,
            Self::LastSent => 1,
        }
    }

    /// Whether a region whose pixels are lost on their way out has no reference any more.
    #[must_use]
    pub fn is_lost_with_its_region(self) -> bool {
        match self {
            Self::Previous => false,
            Self::LastSent => true,
        }
    }
}
