// SPDX-License-Identifier: MIT OR Apache-2.0
//! The encoder of the words of a file.

use super::evt2::Evt2Encoder;
use super::evt3::Evt3Encoder;
use super::header::{EvtVersion, header_text};
use crate::events::{EventFileError, PixelEvent};

/// The longest pause between two events. A stream has a dozen bytes for each loop of its times, of
/// which a pause may have many.
const MAX_PAUSE_US: u64 = 30 * 24 * 3600 * 1_000_000;

/// Makes words of events.
#[derive(Clone, Debug)]
pub(crate) enum EvtEncoder {
    Evt2(Evt2Encoder),
    Evt3(Evt3Encoder),
}

impl EvtEncoder {
    /// Makes an encoder for a sensor of `size` (width, height) pixels. Returns it with the header
    /// of the file.
    pub(crate) fn new(version: EvtVersion, size: (u32, u32)) -> (Self, String) {
        let encoder = match version {
            EvtVersion::Evt2 => Self::Evt2(Evt2Encoder::new()),
            EvtVersion::Evt3 => Self::Evt3(Evt3Encoder::new()),
        };
        (encoder, header_text(version, size))
    }

    /// Appends the words of an event, which is not earlier than the last one, at `last_us`.
    pub(crate) fn push(
        &mut self,
        event: PixelEvent,
        last_us: u64,
        bytes: &mut Vec<u8>,
    ) -> Result<(), EventFileError> {
        let to_us = event.time_us;
        if to_us - last_us > MAX_PAUSE_US {
            return Err(EventFileError::PauseTooLong { from_us: last_us, to_us });
        }
        match self {
            Self::Evt2(encoder) => encoder.push(event, bytes),
            Self::Evt3(encoder) => encoder.push(event, bytes),
        }
        Ok(())
    }

    /// Appends the words of all events that wait.
    pub(crate) fn finish(&mut self, bytes: &mut Vec<u8>) {
        match self {
            Self::Evt2(_) => {}
            Self::Evt3(encoder) => encoder.flush(bytes),
        }
    }
}
