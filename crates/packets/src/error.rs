// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of this crate: a stream cannot be read at all, or a packet cannot be written. Damage
//! is no error: it is reported as losses.

use thiserror::Error;

/// An error in the format of a stream or of a packet to be written.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum PacketError {
    /// The stream has no FRAME packet.
    #[error(
        "`{stream}` has no FRAME packet in its {bytes} bytes; it must be a stream of region packets, such as `foveate \
         simulate --packets` writes"
    )]
    NoFrame { stream: String, bytes: u64 },
    /// The stream has another version of the format.
    #[error(
        "frame {frame} of the stream has version {version} of the packet format; this program reads version 1"
    )]
    UnsupportedVersion { frame: u32, version: u16 },
    /// The stream belongs to another design.
    #[error(
        "frame {frame} of the stream was sent by design {stream:016x}, but the configuration makes design {given:016x} of \
         its {width}x{height} pixels; give the configuration of the camera that sent it"
    )]
    DesignMismatch { frame: u32, stream: u64, given: u64, width: u16, height: u16 },
    /// The fingerprint is that of the design, but another field of the FRAME differs.
    #[error(
        "frame {frame} of the stream has design {stream:016x}, but not its {what}; the sender breaks the format"
    )]
    FieldMismatch { frame: u32, stream: u64, what: &'static str },
    /// A number is outside the range of its field, or of the design.
    #[error("the {field} of a packet cannot be {value}: it is {least} to {most}")]
    FieldOutOfRange { field: &'static str, value: u64, least: u64, most: u64 },
    /// A displacement is outside the search of the design.
    #[error(
        "the displacement of a packet cannot be ({dx}, {dy}): dx and dy are -{radius} to {radius}"
    )]
    DisplacementOutOfRange { dx: i8, dy: i8, radius: u32 },
    /// The number of values differs from that in such a packet of the design.
    #[error("a {packet} of this design carries {right} {what}, not {found}")]
    ValueCountMismatch { packet: &'static str, what: &'static str, found: usize, right: usize },
}

impl PacketError {
    /// Returns the number of the frame that is refused, if there is one.
    #[must_use]
    pub fn frame(&self) -> Option<u32> {
        match *self {
            Self::NoFrame { .. }
            | Self::FieldOutOfRange { .. }
            | Self::DisplacementOutOfRange { .. }
            | Self::ValueCountMismatch { .. } => None,
            Self::UnsupportedVersion { frame, .. }
            | Self::DesignMismatch { frame, .. }
            | Self::FieldMismatch { frame, .. } => Some(frame),
        }
    }
}
