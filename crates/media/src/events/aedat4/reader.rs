// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reader of packets.

use std::io::{self, BufRead, Read as _};

use super::event_packet::{EVENTS_IDENTIFIER, EventQueue, MAX_PACKET_BYTES};
use super::flat_table::FlatTable;
use super::header::{Aedat4Header, StreamInfo};
use crate::events::{EventFileError, PixelEvent};

/// The bytes before a packet: the number of its stream, and its length.
const PACKET_HEADER_BYTES: usize = 8;

/// Reads the events of a file, in its order.
#[derive(Debug)]
pub(crate) struct Aedat4Reader<R> {
    input: R,
    header: Aedat4Header,
    /// The stream of the events; `None` until a packet has events, if the header does not name the
    /// streams.
    stream: Option<i32>,
    /// The place of the next packet in the file, in bytes from 0, and that of the last one.
    next_at: u64,
    packet_at: u64,
    queue: EventQueue,
    /// A packet as it is in the file, and its content.
    packed: Vec<u8>,
    content: Vec<u8>,
}

/// The bytes before a packet.
struct PacketHeader {
    stream: i32,
    length: u64,
}

impl<R: BufRead> Aedat4Reader<R> {
    /// Reads the header of a file.
    pub(crate) fn open(mut input: R) -> Result<Self, EventFileError> {
        let header = Aedat4Header::read(&mut input)?;
        let stream = event_stream(&header.streams)?.map(|stream| stream.number);
        let at = header.bytes;
        let (packed, content) = (Vec::new(), Vec::new());
        let queue = EventQueue::default();
        Ok(Self { input, header, stream, next_at: at, packet_at: at, queue, packed, content })
    }

    /// Returns the width and height of the sensor in pixels, if the header has them.
    pub(crate) fn size(&self) -> Option<(u32, u32)> {
        self.header.streams.iter().find(|stream| stream.has_events())?.size
    }

    /// Returns the place of the packet of the last event, in bytes from 0.
    pub(crate) fn event_place(&self) -> u64 {
        self.packet_at
    }

    /// Returns the next event; `None` at the end of the file.
    pub(crate) fn next_event(&mut self) -> Result<Option<PixelEvent>, EventFileError> {
        loop {
            if let Some(event) = self.queue.pop() {
                return event.map(Some).map_err(|problem| self.damaged(problem));
            }
            let Some(packet) = self.next_packet()? else { return Ok(None) };
            self.take(&packet)?;
        }
    }

    /// Reads the bytes before the next packet. Returns `None` after the last one.
    fn next_packet(&mut self) -> Result<Option<PacketHeader>, EventFileError> {
        self.packet_at = self.next_at;
        match self.header.table_at {
            Some(table_at) if self.packet_at == table_at => return Ok(None),
            Some(table_at) if self.packet_at > table_at => {
                return Err(self.damaged(format!(
                    "the header says that the packets end at byte {table_at}, which is within a packet; the file may \
                     be damaged"
                )));
            }
            _ => {}
        }
        self.packed.clear();
        let found =
            (&mut self.input).take(PACKET_HEADER_BYTES as u64).read_to_end(&mut self.packed)?;
        let &[s0, s1, s2, s3, l0, l1, l2, l3] = self.packed.as_slice() else {
            return match self.header.table_at {
                None if found == 0 => Ok(None),
                _ => Err(self.cut_off("before a packet is complete")),
            };
        };
        let stream = i32::from_le_bytes([s0, s1, s2, s3]);
        let length = i32::from_le_bytes([l0, l1, l2, l3]);
        let Ok(length) = u64::try_from(length) else {
            return Err(self.damaged(format!(
                "a packet states a length of {length} bytes; the file may be damaged"
            )));
        };
        self.next_at += PACKET_HEADER_BYTES as u64 + length;
        Ok(Some(PacketHeader { stream, length }))
    }

    /// Takes the events of a packet. A packet of another stream is skipped.
    fn take(&mut self, packet: &PacketHeader) -> Result<(), EventFileError> {
        let &PacketHeader { stream, length } = packet;
        let is_named = self.header.streams.iter().any(|other| other.number == stream);
        if !is_named && !self.header.streams.is_empty() {
            return Err(self.damaged(format!(
                "a packet has stream {stream}, which the header does not name; the file may be damaged"
            )));
        }
        if is_named && self.stream != Some(stream) {
            return self.skip(length);
        }
        self.unpack(length)?;
        let table = FlatTable::new(&self.content);
        let has_events = table
            .and_then(FlatTable::identifier)
            .is_some_and(|found| found == *EVENTS_IDENTIFIER.as_bytes());
        if !is_named && !has_events {
            return Ok(());
        }
        let events = table.filter(|_| has_events).and_then(|table| self.queue.fill(table));
        events
            .ok_or_else(|| self.damaged("a packet has no valid events; the file may be damaged"))?;
        match *self.stream.get_or_insert(stream) {
            first if first == stream => Ok(()),
            first => Err(self.damaged(several_streams(first, stream))),
        }
    }

    /// Reads the content of a packet.
    fn unpack(&mut self, length: u64) -> Result<(), EventFileError> {
        if length > MAX_PACKET_BYTES {
            return Err(self.too_large());
        }
        self.packed.clear();
        let found = (&mut self.input).take(length).read_to_end(&mut self.packed)?;
        if (found as u64) < length {
            return Err(self.cut_off("within a packet"));
        }
        let unpacked = self.header.compression.unpack(&self.packed, &mut self.content);
        unpacked.map_err(|error| {
            self.damaged(format!("a packet cannot be unpacked ({error}); the file may be damaged"))
        })?;
        if self.content.len() as u64 > MAX_PACKET_BYTES { Err(self.too_large()) } else { Ok(()) }
    }

    fn skip(&mut self, length: u64) -> Result<(), EventFileError> {
        let skipped = io::copy(&mut (&mut self.input).take(length), &mut io::sink())?;
        if skipped < length { Err(self.cut_off("within a packet")) } else { Ok(()) }
    }

    fn too_large(&self) -> EventFileError {
        self.damaged(format!(
            "a packet of events has more than {MAX_PACKET_BYTES} bytes, the limit of this reader"
        ))
    }

    fn cut_off(&self, place: &str) -> EventFileError {
        self.damaged(format!("the file ends {place}; it may be cut off"))
    }

    fn damaged(&self, problem: impl Into<String>) -> EventFileError {
        EventFileError::Stream { at: self.packet_at, problem: problem.into() }
    }
}

/// Returns the stream with the events; `None` if the header names no streams.
fn event_stream(streams: &[StreamInfo]) -> Result<Option<&StreamInfo>, EventFileError> {
    let mut with_events = streams.iter().filter(|stream| stream.has_events());
    let problem = match (with_events.next(), with_events.next()) {
        (Some(first), Some(second)) => several_streams(first.number, second.number),
        (Some(stream), None) => return Ok(Some(stream)),
        (None, _) if streams.is_empty() => return Ok(None),
        (None, _) => {
            let names: Vec<&str> =
                streams.iter().map(|stream| stream.identifier.as_str()).collect();
            format!("no stream of the file has events (EVTS); its streams are {}", names.join(", "))
        }
    };
    Err(EventFileError::Header { problem })
}

fn several_streams(first: i32, second: i32) -> String {
    format!(
        "streams {first} and {second} both have events, and only files of one sensor can be read"
    )
}
