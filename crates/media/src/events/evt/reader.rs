// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reader of the words of a file.

use std::io::{BufRead, ErrorKind};

use super::evt2::Evt2Decoder;
use super::evt3::Evt3Decoder;
use super::header::{EvtHeader, EvtVersion};
use crate::events::{EventFileError, PixelEvent};

/// Reads the events of a file, in its order.
#[derive(Debug)]
pub(crate) struct EvtReader<R> {
    input: R,
    version: EvtVersion,
    size: Option<(u32, u32)>,
    words: WordDecoder,
    /// The place of the next word in the file, in bytes from 0.
    at: u64,
}

#[derive(Clone, Debug)]
enum WordDecoder {
    Evt2(Evt2Decoder),
    Evt3(Evt3Decoder),
}

impl<R: BufRead> EvtReader<R> {
    /// Reads the header of a file.
    pub(crate) fn open(mut input: R) -> Result<Self, EventFileError> {
        let EvtHeader { version, size, bytes: at } = EvtHeader::read(&mut input)?;
        let words = match version {
            EvtVersion::Evt2 => WordDecoder::Evt2(Evt2Decoder::new()),
            EvtVersion::Evt3 => WordDecoder::Evt3(Evt3Decoder::new()),
        };
        Ok(Self { input, version, size, words, at })
    }

    pub(crate) fn version(&self) -> EvtVersion {
        self.version
    }

    /// Returns the width and height of the sensor in pixels, if the header has them.
    pub(crate) fn size(&self) -> Option<(u32, u32)> {
        self.size
    }

    /// Returns the place of the word of the last event, in bytes from 0.
    pub(crate) fn event_place(&self) -> u64 {
        self.at - self.version.word_bytes() as u64
    }

    /// Returns the next event; `None` at the end of the file.
    pub(crate) fn next_event(&mut self) -> Result<Option<PixelEvent>, EventFileError> {
        loop {
            let waiting = match &mut self.words {
                WordDecoder::Evt2(_) => None,
                WordDecoder::Evt3(decoder) => decoder.next_of_vector(),
            };
            if waiting.is_some() {
                return Ok(waiting);
            }
            let Some(word) = self.next_word()? else { return Ok(None) };
            let event = match &mut self.words {
                WordDecoder::Evt2(decoder) => decoder.take(word),
                WordDecoder::Evt3(decoder) => {
                    decoder.take(u16::try_from(word).expect("it has 16 bits"))
                }
            };
            if event.is_some() {
                return Ok(event);
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
}
