// SPDX-License-Identifier: MIT OR Apache-2.0
//! A packet of events ([`EventQueue`]): a flatbuffer with a vector of 16 bytes for each event,
//! which are the time, the column, the row, the polarity, and three bytes that are 0. A packet
//! may be compressed ([`PacketCompression`]).

use super::flat_table::FlatTable;
use crate::events::PixelEvent;
use flatbuffers::{FlatBufferBuilder, field_index_to_field_offset};
use lz4_flex::frame::{FrameDecoder, FrameEncoder};
use ruzstd::decoding::StreamingDecoder;
use std::io::{self, Read, Write};

pub(super) const EVENTS_IDENTIFIER: &str = "EVTS";
/// The field of the table that has the events.
const ELEMENTS: u16 = 0;
const EVENT_BYTES: usize = 16;

/// Returns the flatbuffer of some events.
pub(super) fn packet_of_events(events: &[PixelEvent]) -> Vec<u8> {
    let mut builder = FlatBufferBuilder::with_capacity((events.len() + 4) * EVENT_BYTES);
    // A struct is written as two numbers of 64 bits, from its end: a type of its own would need
    // unsafe code.
    builder.start_vector::<u64>(2 * events.len());
    for event in events.iter().rev() {
        let place = u64::from(event.x) | u64::from(event.y) << 16;
        builder.push(place | u64::from(event.is_brighter) << 32);
        builder.push(event.time_us);
    }
    let elements = builder.end_vector::<u64>(events.len());
    let table = builder.start_table();
    builder.push_slot_always(field_index_to_field_offset(ELEMENTS), elements);
    let table = builder.end_table(table);
    builder.finish_size_prefixed(table, Some(EVENTS_IDENTIFIER));
    builder.finished_data().to_vec()
}

/// The events of a packet that were not taken yet.
#[derive(Clone, Debug, Default)]
pub(super) struct EventQueue {
    bytes: Vec<u8>,
    next: usize,
}

impl EventQueue {
    /// Takes the events of a packet, after all others were taken. Returns `None` if it is damaged.
    pub(super) fn fill(&mut self, table: FlatTable<'_>) -> Option<()> {
        self.next = 0;
        self.bytes.clear();
        self.bytes.extend(table.vector(ELEMENTS, EVENT_BYTES).ok()?.unwrap_or_default());
        Some(())
    }

    /// Returns the next event, or the problem of its values; `None` after the last one.
    pub(super) fn pop(&mut self) -> Option<Result<PixelEvent, String>> {
        let bytes: &[u8; EVENT_BYTES] = self.bytes.get(self.next..)?.first_chunk()?;
        self.next += EVENT_BYTES;
        let [time @ .., x0, x1, y0, y1, polarity, _, _, _] = *bytes;
        let side = |bytes| i16::from_le_bytes(bytes);
        let (x, y, time) = (side([x0, x1]), side([y0, y1]), i64::from_le_bytes(time));
        let unsigned =
            u16::try_from(x).ok().zip(u16::try_from(y).ok()).zip(u64::try_from(time).ok());
        let event = unsigned.map(|((x, y), time_us)| {
            let is_brighter = polarity != 0;
            PixelEvent { x, y, time_us, is_brighter }
        });
        Some(event.ok_or_else(|| {
            format!(
                "an event has the pixel ({x}, {y}) and the time {time} us, and none of them can be negative; the \
                 file may be damaged"
            )
        }))
    }
}

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
    /// Returns the compression that a header states as a number. The levels of a compression have
    /// numbers of their own.
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
