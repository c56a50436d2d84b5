// SPDX-License-Identifier: MIT OR Apache-2.0
//! An event of a pixel.

/// An event of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelEvent {
    /// The column of the pixel.
    pub x: u16,
    /// The row of the pixel.
    pub y: u16,
    /// The time in microseconds.
    pub time_us: u64,
    /// True if the pixel became brighter: the polarity.
    pub is_brighter: bool,
}
