// SPDX-License-Identifier: MIT OR Apache-2.0
//! What every frame says of itself and of its camera.

/// What a FRAME says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameInfo {
    /// Version of the format.
    pub version: u16,
    /// Fingerprint of the design.
    pub fingerprint: u64,
    /// Ticks of `time` in a second.
    pub ticks_per_second: u32,
    /// Frame width W in pixels.
    pub width: u16,
    /// Frame height H in pixels.
    pub height: u16,
    /// Regions side by side.
    pub columns: u16,
    /// Regions one below the other.
    pub rows: u16,
    /// Side of a region N.
    pub side: u8,
    /// Bits of a pixel P.
    pub pixel_bits: u8,
    /// Blocks per side of a summary q; 0 where none are sent.
    pub blocks: u8,
    /// What is shown of irrelevant regions: 0 zero, 1 hold, 2 mean.
    pub irrelevant: u8,
    /// Whether pixels are raw.
    pub raw: bool,
    /// Whether scores are sent.
    pub has_scores: bool,
    /// Whether it is the first frame since reset.
    pub first: bool,
    /// When the frame began, in ticks.
    pub time: u64,
}
