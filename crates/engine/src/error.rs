// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of the engine.

use foveate_camera::ClassMapError;
use thiserror::Error;

/// The error that is returned if pixels are not a frame of the camera, a map does not fit it, or
/// threads cannot be started.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum EngineError {
    /// The frame has another size or depth than the camera.
    #[error("the frame has {given}, but the camera takes {expected}; give it frames of that kind")]
    FrameSizeOrDepth { given: String, expected: String },
    /// There are too few pixels, or the rows overlap.
    #[error(
        "{given} pixels with a stride of {stride} do not hold a frame of {width}x{height}; \
         the stride must be at least {width}, and {needed} pixels are needed"
    )]
    FrameLength { given: usize, stride: usize, width: usize, height: usize, needed: usize },
    /// A pixel does not fit into the camera's bits.
    #[error("pixel ({x}, {y}) is {value}; the largest value of {bits} bits is {max}")]
    PixelRange { x: usize, y: usize, value: u64, bits: u32, max: u32 },
    /// The pixels have the wrong type for the camera's depth.
    #[error("pixels of {bits} bits need the type {expected}, but {given} was given")]
    PixelWidth { bits: u32, expected: &'static str, given: &'static str },
    /// One frame of a batch is refused.
    #[error("frame {number} of the batch: {error}")]
    BatchFrame { number: usize, error: Box<EngineError> },
    /// A map that does not fit the camera.
    #[error(transparent)]
    ClassMap(#[from] ClassMapError),
    /// More threads are asked for than an engine takes.
    #[error("threads = {threads}: expected 1 to {most}, or 0, which takes one per processor")]
    TooManyThreads { threads: usize, most: usize },
    /// The system cannot start the threads.
    #[error("the system cannot start {threads} threads: {reason}; ask for fewer")]
    Threads { threads: usize, reason: String },
}
