// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pixels of a word, stored without an allocation.

/// Largest number of pixels of a word.
const MAX_WORD_PIXELS: usize = 4;

/// The pixels of a word, the left one first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct WordPixels {
    pixels: [u16; MAX_WORD_PIXELS],
    count: usize,
}

impl WordPixels {
    /// Makes a word without pixels.
    pub(super) fn empty() -> Self {
        Self { pixels: [0; MAX_WORD_PIXELS], count: 0 }
    }

    pub(super) fn from_slice(pixels: &[u16]) -> Self {
        let pixel = |place| pixels.get(place).copied().unwrap_or_default();
        Self { pixels: std::array::from_fn(pixel), count: pixels.len() }
    }

    /// Makes a word of `count` equal pixels.
    pub(super) fn repeat(pixel: u16, count: usize) -> Self {
        Self { pixels: [pixel; MAX_WORD_PIXELS], count }
    }

    pub(super) fn as_slice(&self) -> &[u16] {
        &self.pixels[..self.count]
    }
}
