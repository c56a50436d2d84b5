// SPDX-License-Identifier: MIT OR Apache-2.0
//! The description of a frame and its camera in every FRAME packet.

/// The content of a FRAME packet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameInfo {
    /// The version of the format.
    pub version: u16,
    /// The fingerprint of the design.
    pub fingerprint: u64,
    /// The number of ticks per second of `time`.
    pub ticks_per_second: u32,
    /// The frame width W in pixels.
    pub width: u16,
    /// The frame height H in pixels.
    pub height: u16,
    /// The number of columns of regions.
    pub columns: u16,
    /// The number of rows of regions.
    pub rows: u16,
    /// The side N of a region in pixels.
    pub side: u8,
    /// The number P of bits of a pixel.
    pub pixel_bits: u8,
    /// The number q of blocks along a side of a region; 0 without summaries.
    pub blocks: u8,
    /// The content of irrelevant regions: 0 zero, 1 hold, 2 mean.
    pub irrelevant: u8,
    /// True if pixels are raw.
    pub raw: bool,
    /// True if scores are sent.
    pub has_scores: bool,
    /// True if this is the first frame since reset.
    pub first: bool,
    /// The number of maps of classes that have been committed since the core was configured, modulo
    /// 65,536, when the frame began. It is always 0 in a design without zones.
    pub map_version: u16,
    /// The time at which the frame began, in ticks.
    pub time: u64,
}
