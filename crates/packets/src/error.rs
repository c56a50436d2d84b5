// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why a stream cannot be read at all, or a packet not be written. Damage is no error: it is reported as losses.

use thiserror::Error;

/// A stream of something else, or a packet that its format has no room for.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PacketError {
    /// There is no FRAME.
    #[error(
        "`{stream}` has no FRAME packet in its {bytes} bytes; it must be a stream of region packets, such as `foveate \
         simulate --packets` writes"
    )]
    NoFrame {
        /// What was read.
        stream: String,
        /// Its length.
        bytes: u64,
    },
    /// A format of another time.
    #[error(
        "frame {frame} of the stream has version {version} of the packet format; this program reads version 1"
    )]
    Version {
        /// Number of the frame.
        frame: u32,
        /// Its version.
        version: u16,
    },
    /// A stream of another design.
    #[error(
        "frame {frame} of the stream was sent by design {stream:016x}, but the configuration makes design {given:016x} of \
         its {width}x{height} pixels; give the configuration of the camera that sent it"
    )]
    Design {
        /// Number of the frame.
        frame: u32,
        /// Fingerprint in the stream.
        stream: u64,
        /// Fingerprint of the design that was given.
        given: u64,
        /// Frame width in the stream.
        width: u16,
        /// Frame height in the stream.
        height: u16,
    },
    /// The right fingerprint, and yet other packets.
    #[error(
        "frame {frame} of the stream has design {stream:016x}, but not its {what}; the sender breaks the format"
    )]
    Fields {
        /// Number of the frame.
        frame: u32,
        /// Fingerprint in the stream.
        stream: u64,
        /// What differs.
        what: &'static str,
    },
    /// A number that is out of the range of its field, or of the design.
    #[error("the {field} of a packet cannot be {value}: it is {least} to {most}")]
    Field {
        /// Which.
        field: &'static str,
        /// The number.
        value: u64,
        /// The smallest that the field takes.
        least: u64,
        /// The largest that it takes.
        most: u64,
    },
    /// More or less than a packet of the design carries.
    #[error("a {packet} of this design carries {right} {what}, not {found}")]
    Count {
        /// The type of the packet.
        packet: &'static str,
        /// The quantity in the field.
        what: &'static str,
        /// The value that was given.
        found: usize,
        /// The largest value of the field.
        right: usize,
    },
}

impl PacketError {
    /// Number of the frame that is refused, if there is one.
    #[must_use]
    pub fn frame(&self) -> Option<u32> {
        match *self {
            Self::NoFrame { .. } | Self::Field { .. } | Self::Count { .. } => None,
            Self::Version { frame, .. }
            | Self::Design { frame, .. }
            | Self::Fields { frame, .. } => Some(frame),
        }
    }
}
