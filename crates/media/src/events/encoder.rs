// SPDX-License-Identifier: MIT OR Apache-2.0
//! The encoder of a file.

use crate::events::aedat4::Aedat4Encoder;
use crate::events::evt::{EvtEncoder, EvtVersion};
use crate::events::frame_size::check_frame_size;
use crate::events::{EventFileError, EventFormat, PixelEvent};

/// Makes the bytes of a file, for an event after the other.
#[derive(Clone, Debug)]
pub struct EventEncoder {
    encoder: FormatEncoder,
    /// The width and height of the sensor in pixels.
    size: (u32, u32),
    last_us: u64,
}

#[derive(Clone, Debug)]
enum FormatEncoder {
    Evt(EvtEncoder),
    Aedat4(Aedat4Encoder),
}

impl EventEncoder {
    /// Makes an encoder for a sensor of `size` (width, height) pixels. Returns it with the header
    /// of the file.
    ///
    /// # Errors
    /// Fails if a side has more than [`EventFormat::max_side`] pixels.
    pub fn new(format: EventFormat, size: (u32, u32)) -> Result<(Self, Vec<u8>), EventFileError> {
        check_frame_size(format, size)?;
        let evt = |version| {
            let (encoder, header) = EvtEncoder::new(version, size);
            (FormatEncoder::Evt(encoder), header.into_bytes())
        };
        let (encoder, header) = match format {
            EventFormat::Evt2 => evt(EvtVersion::Evt2),
            EventFormat::Evt3 => evt(EvtVersion::Evt3),
            EventFormat::Aedat4 => {
                let (encoder, header) = Aedat4Encoder::new(size);
                (FormatEncoder::Aedat4(encoder), header)
            }
        };
        Ok((Self { encoder, size, last_us: 0 }, header))
    }

    /// Appends the bytes of an event. In EVT 3.0 and AEDAT4 they may wait for the next events. An
    /// event that is earlier than the last one gets the time of the last one, because a time cannot
    /// go back.
    ///
    /// # Errors
    /// Fails if the event is outside of the sensor. In EVT it fails if the event is more than 30
    /// days after the last one, or after 0, and in AEDAT4 if its time has more than 63 bits.
    pub fn push(&mut self, event: PixelEvent, bytes: &mut Vec<u8>) -> Result<(), EventFileError> {
        let (width, height) = self.size;
        if u32::from(event.x) >= width || u32::from(event.y) >= height {
            let (x, y) = (event.x, event.y);
            return Err(EventFileError::EventOutside { x, y, width, height });
        }
        let time_us = self.last_us.max(event.time_us);
        let event = PixelEvent { time_us, ..event };
        match &mut self.encoder {
            FormatEncoder::Evt(encoder) => encoder.push(event, self.last_us, bytes)?,
            FormatEncoder::Aedat4(encoder) => encoder.push(event, bytes)?,
        }
        self.last_us = time_us;
        Ok(())
    }

    /// Appends the bytes of all events that wait, so that the file is complete.
    pub fn finish(&mut self, bytes: &mut Vec<u8>) {
        match &mut self.encoder {
            FormatEncoder::Evt(encoder) => encoder.finish(bytes),
            FormatEncoder::Aedat4(encoder) => encoder.finish(bytes),
        }
    }
}
