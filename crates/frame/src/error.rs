// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a frame.

use thiserror::Error;

/// The error that is returned when pixels do not make a frame.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameError {
    /// A side of the frame is zero.
    #[error("a frame of {width}x{height} pixels is empty; both sides must be at least 1")]
    EmptyFrame {
        /// The width that was given.
        width: u32,
        /// The height that was given.
        height: u32,
    },
    /// The number of bits per pixel is out of range.
    #[error("{bits} bits per pixel are not supported; a pixel has 1 to 16 bits")]
    PixelBits {
        /// The number of bits that was given.
        bits: u32,
    },
    /// There are too few or too many pixels for the size.
    #[error("a frame of {width}x{height} needs {needed} pixels, but {given} were given")]
    FrameLength {
        /// The width that was given.
        width: u32,
        /// The height that was given.
        height: u32,
        /// The number of pixels that the size needs.
        needed: u64,
        /// The number of pixels that were given.
        given: usize,
    },
    /// A pixel does not fit into its bits.
    #[error("pixel ({x}, {y}) is {value}; the largest value of {bits} bits is {max}")]
    PixelRange {
        /// The column of the pixel.
        x: u32,
        /// The row of the pixel.
        y: u32,
        /// The value of the pixel.
        value: u16,
        /// The bits per pixel.
        bits: u32,
        /// The largest value of this number of bits.
        max: u16,
    },
}
