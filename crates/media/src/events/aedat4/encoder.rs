// SPDX-License-Identifier: MIT OR Apache-2.0
//! The encoder of packets of events, which are compressed with LZ4.

use super::event_packet::{lz4_frame, packet_of_events};
use super::header::{EVENT_STREAM, header_bytes};
use crate::events::{EventFileError, PixelEvent};

/// The events of a packet, of which only the last may have less.
const PACKET_EVENTS: usize = 1 << 12;

/// Makes packets of events.
#[derive(Clone, Debug)]
pub(crate) struct Aedat4Encoder {
    waiting: Vec<PixelEvent>,
}

impl Aedat4Encoder {
    /// Makes an encoder for a sensor of `size` (width, height) pixels. Returns it with the header
    /// of the file.
    pub(crate) fn new(size: (u32, u32)) -> (Self, Vec<u8>) {
        (Self { waiting: Vec::with_capacity(PACKET_EVENTS) }, header_bytes(size))
    }

    /// Takes an event, and appends a packet if there are enough.
    pub(crate) fn push(
        &mut self,
        event: PixelEvent,
        bytes: &mut Vec<u8>,
    ) -> Result<(), EventFileError> {
        if i64::try_from(event.time_us).is_err() {
            return Err(EventFileError::TimeTooLate { time_us: event.time_us });
        }
        self.waiting.push(event);
        if self.waiting.len() == PACKET_EVENTS {
            self.finish(bytes);
        }
        Ok(())
    }

    /// Appends a packet of all events that wait.
    pub(crate) fn finish(&mut self, bytes: &mut Vec<u8>) {
        if self.waiting.is_empty() {
            return;
        }
        let packed = lz4_frame(&packet_of_events(&self.waiting));
        let length = i32::try_from(packed.len()).expect("a packet is below a megabyte");
        bytes.extend(EVENT_STREAM.to_le_bytes());
        bytes.extend(length.to_le_bytes());
        bytes.extend(packed);
        self.waiting.clear();
    }
}
