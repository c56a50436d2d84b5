// SPDX-License-Identifier: MIT OR Apache-2.0
//! The compression of packets.

use std::io::{self, Read, Write};

use lz4_flex::frame::{FrameDecoder, FrameEncoder};
use ruzstd::decoding::StreamingDecoder;

/// The most bytes of a packet of events, compressed or not, which are 4 million events.
pub(super) const MAX_PACKET_BYTES: u64 = 1 << 26;

/// A compression of packets. All packets of a file have the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PacketCompression {
    None,
    Lz4,
    Zstd,
}

impl PacketCompression {
    /// Returns the compression that a header states as a number. The levels of a compression have numbers of their
    /// own.
    pub(super) fn from_number(number: i32) -> Option<Self> {
        match number {
            0 => Some(Self::None),
            1 | 2 => Some(Self::Lz4),
            3 | 4 => Some(Self::Zstd),
            _ => None,
        }
    }

    /// Reads the content of a packet of `packed` bytes, up to one byte more than the limit.
    pub(super) fn unpack(self, packed: &[u8], content: &mut Vec<u8>) -> io::Result<()> {
        content.clear();
        let limit = MAX_PACKET_BYTES + 1;
        match self {
            Self::None => packed.take(limit).read_to_end(content)?,
            Self::Lz4 => FrameDecoder::new(packed).take(limit).read_to_end(content)?,
            Self::Zstd => {
                let frame = StreamingDecoder::new_with_max_window_size(packed, MAX_PACKET_BYTES);
                frame.map_err(io::Error::other)?.take(limit).read_to_end(content)?
            }
        };
        Ok(())
    }
}

/// Returns some bytes as a frame of LZ4.
pub(super) fn lz4_frame(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = FrameEncoder::new(Vec::new());
    encoder.write_all(bytes).expect("memory takes all bytes");
    encoder.finish().expect("memory takes all bytes")
}
