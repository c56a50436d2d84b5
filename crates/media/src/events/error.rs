// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of files of event cameras.

use std::io;

use thiserror::Error;

use crate::events::EventFormat;

/// An error of a file of an event camera.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum EventFileError {
    /// The frame is too large for the coordinates of the format.
    #[error(
        "{format} holds frames of at most {limit}x{limit} pixels; the frames have {width}x{height}",
        limit = .format.max_side()
    )]
    FrameTooLarge { format: EventFormat, width: u32, height: u32 },
    /// An event is outside of the sensor.
    #[error(
        "an event of pixel ({x}, {y}) is outside of the sensor, which has {width}x{height} pixels"
    )]
    EventOutside { x: u16, y: u16, width: u32, height: u32 },
    /// The pause between two events is too long.
    #[error("there are more than 30 days between two events, at {from_us} and {to_us} us")]
    PauseTooLong { from_us: u64, to_us: u64 },
    /// The time of an event is too late for the format.
    #[error("an event has the time {time_us} us, and AEDAT4 holds times of at most 2^63 - 1 us")]
    TimeTooLate { time_us: u64 },
    /// The file cannot be read.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The header is damaged, or names a format that is not known.
    #[error("{problem}")]
    Header { problem: String },
    /// The stream is damaged.
    #[error("at byte {at}: {problem}")]
    Stream { at: u64, problem: String },
}
