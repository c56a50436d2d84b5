// SPDX-License-Identifier: MIT OR Apache-2.0
//! The losses of a stream.

use std::fmt;

/// A part of a stream that is missing or cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StreamLoss {
    /// Bytes that belong to no packet.
    Bytes {
        /// The offset of the first byte in the stream.
        offset: u64,
        /// The number of bytes.
        bytes: u64,
    },
    /// The stream begins in the middle of a run, so the screen before it is unknown.
    Start {
        /// The number of the first frame.
        frame: u32,
    },
    /// Frames without any packet.
    Frames {
        /// The number of the first missing frame.
        frame: u32,
        /// The number of missing frames.
        count: u32,
    },
    /// The FRAME of a frame is missing, and with it the time: the frame is not written.
    Frame {
        /// The number of the frame.
        frame: u32,
    },
    /// The decisions of a row of regions are missing.
    Row {
        /// The number of the frame.
        frame: u32,
        /// The row of regions.
        row: u32,
        /// True if the camera may have dropped them.
        dropped: bool,
    },
    /// The scores of a row of regions are missing.
    Scores {
        /// The number of the frame.
        frame: u32,
        /// The row of regions.
        row: u32,
    },
    /// The displacements of a row of regions are missing.
    Flow {
        /// The number of the frame.
        frame: u32,
        /// The row of regions.
        row: u32,
    },
    /// The pixels or means of a region are missing.
    Region {
        /// The number of the frame.
        frame: u32,
        /// The row of regions.
        row: u32,
        /// The column of regions.
        column: u32,
        /// True if the camera may have dropped the region.
        dropped: bool,
    },
    /// The END of a frame is missing.
    End {
        /// The number of the frame.
        frame: u32,
    },
    /// Packets contradict others or come too late.
    Misplaced {
        /// The number of the frame in these packets.
        frame: u32,
        /// The number of packets.
        count: u32,
    },
    /// The time of a frame is before that of the previous frame, or too far after it.
    Time {
        /// The number of the frame.
        frame: u32,
    },
    /// A FRAME comes from another camera or has another format. It is ignored with all packets up
    /// to the next FRAME of this camera.
    Foreign {
        /// The number of the frame in the ignored FRAME.
        frame: u32,
    },
}

impl StreamLoss {
    /// Returns the kind of the loss as one word.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Bytes { .. } => "bytes",
            Self::Start { .. } => "start",
            Self::Frames { .. } => "frames",
            Self::Frame { .. } => "frame",
            Self::Row { dropped: false, .. } => "row",
            Self::Row { dropped: true, .. } => "dropped-row",
            Self::Scores { .. } => "scores",
            Self::Flow { .. } => "flow",
            Self::Region { dropped: false, .. } => "region",
            Self::Region { dropped: true, .. } => "dropped-region",
            Self::End { .. } => "end",
            Self::Misplaced { .. } => "misplaced",
            Self::Time { .. } => "time",
            Self::Foreign { .. } => "foreign",
        }
    }

    /// Returns the frame, the row, the column, the count, and the offset in the stream, as far as
    /// they are known.
    #[must_use]
    pub fn fields(&self) -> [Option<u64>; 5] {
        let some = |value: u32| Some(u64::from(value));
        match *self {
            Self::Bytes { offset, bytes } => [None, None, None, Some(bytes), Some(offset)],
            Self::Frames { frame, count } | Self::Misplaced { frame, count } => {
                [some(frame), None, None, some(count), None]
            }
            Self::Row { frame, row, .. }
            | Self::Scores { frame, row }
            | Self::Flow { frame, row } => [some(frame), some(row), None, None, None],
            Self::Region { frame, row, column, .. } => {
                [some(frame), some(row), some(column), None, None]
            }
            Self::Start { frame }
            | Self::Frame { frame }
            | Self::End { frame }
            | Self::Time { frame }
            | Self::Foreign { frame } => [some(frame), None, None, None, None],
        }
    }
}

impl fmt::Display for StreamLoss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cause = |dropped: bool| if dropped { "dropped by the camera" } else { "missing" };
        match *self {
            Self::Bytes { offset, bytes } => {
                write!(f, "{bytes} bytes from byte {offset} on are not a packet")
            }
            Self::Start { frame } => {
                write!(
                    f,
                    "the stream begins with frame {frame}; what the screen showed before is not known"
                )
            }
            Self::Frames { frame, count: 1 } => write!(f, "frame {frame} is missing"),
            Self::Frames { frame, count } => {
                write!(f, "{count} frames from frame {frame} on are missing")
            }
            Self::Frame { frame } => {
                write!(f, "frame {frame}: its FRAME packet is missing, so it is left out")
            }
            Self::Row { frame, row, dropped } => {
                write!(f, "frame {frame}, row {row}: decisions are {}", cause(dropped))
            }
            Self::Scores { frame, row } => {
                write!(f, "frame {frame}, row {row}: scores are missing")
            }
            Self::Flow { frame, row } => {
                write!(f, "frame {frame}, row {row}: displacements are missing")
            }
            Self::Region { frame, row, column, dropped } => {
                write!(
                    f,
                    "frame {frame}, row {row}, column {column}: the region is {}",
                    cause(dropped)
                )
            }
            Self::End { frame } => write!(f, "frame {frame}: its END packet is missing"),
            Self::Misplaced { frame, count: 1 } => {
                write!(
                    f,
                    "a packet of frame {frame} contradicts others or is out of order, and is ignored"
                )
            }
            Self::Misplaced { frame, count } => {
                write!(
                    f,
                    "{count} packets of frame {frame} contradict others or are out of order, and are ignored"
                )
            }
            Self::Time { frame } => {
                write!(
                    f,
                    "frame {frame}: its time is before the last frame or more than a day behind it, and is not used"
                )
            }
            Self::Foreign { frame } => {
                write!(
                    f,
                    "frame {frame} is of another camera or format, and is ignored together with all that follows"
                )
            }
        }
    }
}
