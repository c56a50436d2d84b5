// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of files of event cameras.

use std::io;

use thiserror::Error;

use crate::EventFormat;

/// An error of a file of an event camera.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EventFileError {
    /// The frame is too large for the coordinates of the format.
    #[error(
        "{format} holds frames of at most {limit}x{limit} pixels; the frames have {width}x{height}",
        limit = .format.max_side()
    )]
    FrameTooLarge {
        /// The format.
        format: EventFormat,
        /// The width of the frames in pixels.
        width: u32,
        /// The height of the frames in pixels.
        height: u32,
    },
    /// An event is outside of the sensor.
    #[error(
        "an event of pixel ({x}, {y}) is outside of the sensor, which has {width}x{height} pixels"
    )]
    EventOutside {
        /// The column of the pixel.
        x: u16,
        /// The row of the pixel.
        y: u16,
        /// The width of the sensor in pixels.
        width: u32,
        /// The height of the sensor in pixels.
        height: u32,
    },
    /// The pause between two events is too long.
    #[error("there are more than 30 days between two events, at {from_us} and {to_us} us")]
    PauseTooLong {
        /// The time of the event before in microseconds.
        from_us: u64,
        /// The time of the event in microseconds.
        to_us: u64,
    },
    /// The time of an event is too late for the format.
    #[error("an event has the time {time_us} us, and AEDAT4 holds times of at most 2^63 - 1 us")]
    TimeTooLate {
        /// The time of the event in microseconds.
        time_us: u64,
    },
    /// The file cannot be read.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The header is damaged, or names a format that is not known.
    #[error("{problem}")]
    Header {
        /// The problem, as a sentence.
        problem: String,
    },
    /// The stream is damaged.
    #[error("at byte {at}: {problem}")]
    Stream {
        /// The place of the word or the packet in the file, in bytes from 0.
        at: u64,
        /// The problem, as a sentence.
        problem: String,
    },
}
