// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of the engine.

use foveate_camera::ClassMapError;
use thiserror::Error;

/// The error that is returned if pixels are not a frame of the camera, a map does not fit it, or
/// threads cannot be started.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EngineError {
    /// The frame has another size or depth than the camera.
    #[error("the frame has {given}, but the camera takes {expected}; give it frames of that kind")]
    FrameSizeOrDepth {
        /// The size and the depth of the frame.
        given: String,
        /// The size and the depth of the camera.
        expected: String,
    },
    /// There are too few pixels, or the rows overlap.
    #[error(
        "{given} pixels with a stride of {stride} do not hold a frame of {width}x{height}; \
         the stride must be at least {width}, and {needed} pixels are needed"
    )]
    FrameLength {
        /// The number of pixels that were given.
        given: usize,
        /// The distance from row to row in pixels.
        stride: usize,
        /// The width of the camera.
        width: usize,
        /// The height of the camera.
        height: usize,
        /// The number of pixels that the size needs with this stride, or with the smallest possible
        /// stride.
        needed: usize,
    },
    /// A pixel does not fit into the camera's bits.
    #[error("pixel ({x}, {y}) is {value}; the largest value of {bits} bits is {max}")]
    PixelRange {
        /// The column of the pixel.
        x: usize,
        /// The row of the pixel.
        y: usize,
        /// The value of the pixel.
        value: u64,
        /// The bits per pixel.
        bits: u32,
        /// The largest value of this number of bits.
        max: u32,
    },
    /// The pixels have the wrong type for the camera's depth.
    #[error("pixels of {bits} bits need the type {expected}, but {given} was given")]
    LaneWidth {
        /// The camera's bits per pixel.
        bits: u32,
        /// The type that this depth needs.
        expected: &'static str,
        /// The type that was given.
        given: &'static str,
    },
    /// One frame of a batch is refused.
    #[error("frame {number} of the batch: {error}")]
    BatchFrame {
        /// The number of the frame in the batch, counted from 0.
        number: usize,
        /// The error of that frame.
        error: Box<EngineError>,
    },
    /// A map that does not fit the camera.
    #[error(transparent)]
    ClassMap(#[from] ClassMapError),
    /// More threads are asked for than an engine takes.
    #[error("threads = {threads}: expected 1 to {most}, or 0, which takes one per processor")]
    TooManyThreads {
        /// The number of threads that were asked for.
        threads: usize,
        /// The largest number of threads.
        most: usize,
    },
    /// The system cannot start the threads.
    #[error("the system cannot start {threads} threads: {reason}; ask for fewer")]
    Threads {
        /// The number of threads that were asked for.
        threads: usize,
        /// The reason that the system gives.
        reason: String,
    },
}
