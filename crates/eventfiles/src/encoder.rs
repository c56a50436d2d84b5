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
    /// The width and height of the sensor in pixels.
    size: (u32, u32),
    last_us: u64,
}

/// The longest pause between two events. A stream has a dozen bytes for each loop of its times, of which a pause
/// may have many.
const MAX_PAUSE_US: u64 = 30 * 24 * 3600 * 1_000_000;

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
        Ok((Self { words, size, last_us: 0 }, header_text(version, size)))
    }

    /// Appends the bytes of an event. Those of EVT 3.0 may wait for the next event. An event that is earlier than
    /// the last one gets the time of the last one, because a time cannot go back.
    ///
    /// # Errors
    /// Fails if the event is outside of the sensor, or more than 30 days after the last one, or after 0.
    pub fn push(&mut self, event: PixelEvent, bytes: &mut Vec<u8>) -> Result<(), EventFileError> {
        let (width, height) = self.size;
        if u32::from(event.x) >= width || u32::from(event.y) >= height {
            let (x, y) = (event.x, event.y);
            return Err(EventFileError::EventOutside { x, y, width, height });
        }
        let time_us = self.last_us.max(event.time_us);
        if time_us - self.last_us > MAX_PAUSE_US {
            return Err(EventFileError::PauseTooLong { from_us: self.last_us, to_us: time_us });
        }
        self.last_us = time_us;
        let event = PixelEvent { time_us, ..event };
        match &mut self.words {
            WordEncoder::Evt2(encoder) => encoder.push(event, bytes),
            WordEncoder::Evt3(encoder) => encoder.push(event, bytes),
        }
        Ok(())
    }

    /// Appends the bytes of all events that wait, so that the stream is complete.
    pub fn finish(&mut self, bytes: &mut Vec<u8>) {
        match &mut self.words {
            WordEncoder::Evt2(_) => {}
            WordEncoder::Evt3(encoder) => encoder.flush(bytes),
        }
    }
}
