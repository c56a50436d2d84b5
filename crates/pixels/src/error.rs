// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a frame.

use thiserror::Error;

/// The error that is returned when pixels do not make a frame.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum FrameError {
    /// A side of the frame is zero.
    #[error("a frame of {width}x{height} pixels is empty; both sides must be at least 1")]
    EmptyFrame { width: u32, height: u32 },
    /// The number of bits per pixel is out of range.
    #[error("{bits} bits per pixel are not supported; a pixel has 1 to 16 bits")]
    PixelBits { bits: u32 },
    /// There are too few or too many pixels for the size.
    #[error("a frame of {width}x{height} needs {needed} pixels, but {given} were given")]
    FrameLength { width: u32, height: u32, needed: u64, given: usize },
    /// A pixel does not fit into its bits.
    #[error("pixel ({x}, {y}) is {value}; the largest value of {bits} bits is {max}")]
    PixelRange { x: u32, y: u32, value: u16, bits: u32, max: u16 },
}
