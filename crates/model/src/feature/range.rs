// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `range`: the largest minus the smallest pixel.

/// The smallest and the largest of some pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelExtremes {
    smallest: u16,
    largest: u16,
}

/// The extremes of no pixels.
impl Default for PixelExtremes {
    fn default() -> Self {
        Self { smallest: u16::MAX, largest: 0 }
    }
}

impl PixelExtremes {
    /// Returns the extremes of these pixels and one more.
    #[must_use]
    pub fn with(self, pixel: u16) -> Self {
        Self { smallest: self.smallest.min(pixel), largest: self.largest.max(pixel) }
    }

    /// Returns the score, which is 0 without pixels.
    #[must_use]
    pub fn range(self) -> u64 {
        self.largest.saturating_sub(self.smallest).into()
    }
}
