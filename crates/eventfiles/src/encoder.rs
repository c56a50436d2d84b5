// SPDX-License-Identifier: MIT OR Apache-2.0
//! The encoder of a stream.

use crate::evt2::Evt2Encoder;
use crate::evt3::Evt3Encoder;
use crate::header::header_text;
use crate::{EventFileError, EvtVersion, PixelEvent};

/// Makes the bytes of a file, for an event after the other.
#[derive(Clone, Debug)]
pub struct EvtEncoder {
    words: WordEncoder,
    last_us: u64,
}

#[derive(Clone, Debug)]
enum WordEncoder {
    Evt2(Evt2Encoder),
    Evt3(Evt3Encoder),
}

impl EvtEncoder {
    /// Makes an encoder for a sensor of `size` (width, height) pixels. Returns it with the header of the file.
    ///
    /// # Errors
    /// Fails if a side has more than [`EvtVersion::MAX_SIDE`] pixels.
    pub fn new(version: EvtVersion, size: (u32, u32)) -> Result<(Self, String), EventFileError> {
        let (width, height) = size;
        if width.max(height) > EvtVersion::MAX_SIDE {
            return Err(EventFileError::FrameTooLarge { version, width, height });
        }
        let words = match version {
            EvtVersion::Evt2 => WordEncoder::Evt2(Evt2Encoder::new()),
            EvtVersion::Evt3 => WordEncoder::Evt3(Evt3Encoder::new()),
        };
        Ok((Self { words, last_us: 0 }, header_text(version, size)))
    }

    /// Appends the bytes of an event. Those of EVT 3.0 may wait for the next event. An event that is earlier than
    /// the last one gets the time of the last one, because a time cannot go back.
    pub fn push(&mut self, event: PixelEvent, bytes: &mut Vec<u8>) {
        self.last_us = self.last_us.max(event.time_us);
        let event = PixelEvent { time_us: self.last_us, ..event };
        match &mut self.words {
            WordEncoder::Evt2(encoder) => encoder.push(event, bytes),
            WordEncoder::Evt3(encoder) => encoder.push(event, bytes),
        }
    }

    /// Appends the bytes of all events that wait, so that the stream is complete.
    pub fn finish(&mut self, bytes: &mut Vec<u8>) {
        match &mut self.words {
            WordEncoder::Evt2(_) => {}
            WordEncoder::Evt3(encoder) => encoder.flush(bytes),
        }
    }
}
