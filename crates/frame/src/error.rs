// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of frames: pixels that do not make a frame.

use thiserror::Error;

/// Pixels that do not make a frame.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameError {
    /// A side of the frame is zero.
    #[error("a frame of {width}x{height} pixels is empty; both sides must be at least 1")]
    EmptyFrame {
        /// Width as given.
        width: u32,
        /// Height as given.
        height: u32,
    },
    /// The bits per pixel are out of range.
    #[error("{bits} bits per pixel are not supported; a pixel has 1 to 16 bits")]
    PixelBits {
        /// Bits as given.
        bits: u32,
    },
    /// Too few or too many pixels for the size.
    #[error("a frame of {width}x{height} needs {needed} pixels, but {given} were given")]
    FrameLength {
        /// Width as given.
        width: u32,
        /// Height as given.
        height: u32,
        /// Pixels that size needs.
        needed: u64,
        /// Pixels that came.
        given: usize,
    },
    /// A pixel that does not fit into its bits.
    #[error("pixel ({x}, {y}) is {value}; the largest value of {bits} bits is {max}")]
    PixelRange {
        /// Column of the pixel.
        x: u32,
        /// Row of the pixel.
        y: u32,
        /// Its value.
        value: u16,
        /// Bits per pixel.
        bits: u32,
        /// Largest value of these bits.
        max: u16,
    },
}
