// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reader of a file.

use std::io::{BufRead, ErrorKind};

use crate::evt2::Evt2Decoder;
use crate::evt3::Evt3Decoder;
use crate::header::EvtHeader;
use crate::{EventFileError, EvtVersion, PixelEvent};

/// Reads the events of a file, in its order. After an error there are no more events.
#[derive(Debug)]
pub struct EvtReader<R> {
    input: R,
    version: EvtVersion,
    size: Option<(u32, u32)>,
    words: WordDecoder,
    /// The place of the next word in the file, in bytes from 0.
    at: u64,
    is_done: bool,
}

#[derive(Clone, Debug)]
enum WordDecoder {
    Evt2(Evt2Decoder),
    Evt3(Evt3Decoder),
}

impl<R: BufRead> EvtReader<R> {
    /// Reads the header of a file.
    ///
    /// # Errors
    /// Fails if the file cannot be read, has no header, or has another format than EVT 2.0 or EVT 3.0 in little
    /// endian.
    pub fn open(mut input: R) -> Result<Self, EventFileError> {
        let EvtHeader { version, size, bytes: at } = EvtHeader::read(&mut input)?;
        let words = match version {
            EvtVersion::Evt2 => WordDecoder::Evt2(Evt2Decoder::new()),
            EvtVersion::Evt3 => WordDecoder::Evt3(Evt3Decoder::new()),
        };
        Ok(Self { input, version, size, words, at, is_done: false })
    }

    /// Returns the version of the format.
    #[must_use]
    pub fn version(&self) -> EvtVersion {
        self.version
    }

    /// Returns the width and height of the sensor in pixels, if the header has them.
    #[must_use]
    pub fn size(&self) -> Option<(u32, u32)> {
        self.size
    }

    fn next_event(&mut self) -> Result<Option<PixelEvent>, EventFileError> {
        loop {
            let waiting = match &mut self.words {
                WordDecoder::Evt2(_) => None,
                WordDecoder::Evt3(decoder) => decoder.next_of_vector(),
            };
            if let Some(event) = waiting {
                return self.checked(event).map(Some);
            }
            let Some(word) = self.next_word()? else { return Ok(None) };
            let event = match &mut self.words {
                WordDecoder::Evt2(decoder) => decoder.take(word),
                WordDecoder::Evt3(decoder) => {
                    decoder.take(u16::try_from(word).expect("it has 16 bits"))
                }
            };
            if let Some(event) = event {
                return self.checked(event).map(Some);
            }
        }
    }

    /// Returns the next word; `None` at the end of the file.
    fn next_word(&mut self) -> Result<Option<u32>, EventFileError> {
        let (mut bytes, length) = ([0; 4], self.version.word_bytes());
        let mut found = 0;
        while found < length {
            match self.input.read(&mut bytes[found..length]) {
                Ok(0) => break,
                Ok(count) => found += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
        match found {
            0 => Ok(None),
            found if found < length => {
                let problem =
                    format!("the file ends within a word of {length} bytes; it may be cut off");
                Err(EventFileError::Stream { at: self.at, problem })
            }
            _ => {
                self.at += length as u64;
                Ok(Some(u32::from_le_bytes(bytes)))
            }
        }
    }

    /// Refuses an event outside of the sensor.
    fn checked(&self, event: PixelEvent) -> Result<PixelEvent, EventFileError> {
        let (width, height) = self.size.unwrap_or((EvtVersion::MAX_SIDE, EvtVersion::MAX_SIDE));
        let (x, y) = (u32::from(event.x), u32::from(event.y));
        if x < width && y < height {
            return Ok(event);
        }
        let at = self.at - self.version.word_bytes() as u64;
        let problem = format!(
            "an event of pixel ({x}, {y}) is outside of the sensor, which has {width}x{height} pixels; the file \
             may be damaged"
        );
        Err(EventFileError::Stream { at, problem })
    }
}

impl<R: BufRead> Iterator for EvtReader<R> {
    type Item = Result<PixelEvent, EventFileError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_done {
            return None;
        }
        let event = self.next_event().transpose();
        self.is_done = !matches!(event, Some(Ok(_)));
        event
    }
}
