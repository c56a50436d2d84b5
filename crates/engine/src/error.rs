// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the engine refuses.

use thiserror::Error;

/// The pixels are not a frame of the camera, or the threads cannot be had.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EngineError {
    /// A frame of another size or depth than the camera's.
    #[error("the frame has {given}, but the camera takes {expected}; give it frames of that kind")]
    FrameKind {
        /// Size and depth of the frame.
        given: String,
        /// Size and depth of the camera.
        expected: String,
    },
    /// Too few pixels, or rows that overlap.
    #[error(
        "{given} pixels with a stride of {stride} do not hold a frame of {width}x{height}; \
         the stride must be at least {width}, and {needed} pixels are needed"
    )]
    FrameLength {
        /// Pixels that came.
        given: usize,
        /// Pixels from row to row.
        stride: usize,
        /// Width of the camera.
        width: usize,
        /// Height of the camera.
        height: usize,
        /// Pixels that the size needs with this stride, or with the least possible one.
        needed: usize,
    },
    /// A pixel that does not fit into the camera's bits.
    #[error("pixel ({x}, {y}) is {value}; the largest value of {bits} bits is {max}")]
    PixelRange {
        /// Column of the pixel.
        x: usize,
        /// Row of the pixel.
        y: usize,
        /// Its value.
        value: u64,
        /// Bits per pixel.
        bits: u32,
        /// Largest value of these bits.
        max: u32,
    },
    /// Pixels of the wrong type for the depth.
    #[error("pixels of {bits} bits need the type {expected}, but {given} was given")]
    LaneWidth {
        /// Bits per pixel of the camera.
        bits: u32,
        /// The type they need.
        expected: &'static str,
        /// The type that came.
        given: &'static str,
    },
    /// One of several frames is refused.
    #[error("frame {number} of the batch: {error}")]
    InBatch {
        /// Which one, from 0.
        number: usize,
        /// What is wrong with it.
        error: Box<EngineError>,
    },
    /// More threads than an engine takes.
    #[error("threads = {threads}: expected 1 to {most}, or 0, which takes one per processor")]
    TooManyThreads {
        /// Threads asked for.
        threads: usize,
        /// The most.
        most: usize,
    },
    /// The system gave no threads.
    #[error("the system cannot start {threads} threads: {reason}; ask for fewer")]
    Threads {
        /// Threads asked for.
        threads: usize,
        /// What it says.
        reason: String,
    },
}
