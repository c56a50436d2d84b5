// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reader of a file.

use std::io::BufRead;

use crate::events::aedat4::{self, Aedat4Reader};
use crate::events::evt::{self, EvtReader};
use crate::events::{EventFileError, EventFormat, PixelEvent};

/// Reads the events of a file, in its order. After an error there are no more events.
#[derive(Debug)]
pub struct EventReader<R> {
    reader: FormatReader<R>,
    is_done: bool,
}

#[derive(Debug)]
enum FormatReader<R> {
    Evt(EvtReader<R>),
    Aedat4(Aedat4Reader<R>),
}

/// Returns true if a file with these first bytes may be in a format of this crate. A text whose
/// first line is a comment, `# ...`, is not.
#[must_use]
pub fn is_event_file(start: &[u8]) -> bool {
    start.first() == Some(&evt::HEADER_START) || start.starts_with(b"#!")
}

impl<R: BufRead> EventReader<R> {
    /// Reads the header of a file, from which its format follows.
    ///
    /// # Errors
    /// Fails if the file cannot be read, has no header, or has another format than
    /// [`EventFormat::ALL`]; EVT is read in little endian.
    pub fn open(mut input: R) -> Result<Self, EventFileError> {
        let reader = match input.fill_buf()?.first() {
            Some(&evt::HEADER_START) => FormatReader::Evt(EvtReader::open(input)?),
            Some(&aedat4::HEADER_START) => FormatReader::Aedat4(Aedat4Reader::open(input)?),
            _ => {
                let problem = "the file begins with no header of EVT 2.0, EVT 3.0 or AEDAT4";
                return Err(EventFileError::Header { problem: problem.to_owned() });
            }
        };
        Ok(Self { reader, is_done: false })
    }

    /// Returns the format.
    #[must_use]
    pub fn format(&self) -> EventFormat {
        match &self.reader {
            FormatReader::Evt(reader) => reader.version().format(),
            FormatReader::Aedat4(_) => EventFormat::Aedat4,
        }
    }

    /// Returns the width and height of the sensor in pixels, if the header has them.
    #[must_use]
    pub fn size(&self) -> Option<(u32, u32)> {
        match &self.reader {
            FormatReader::Evt(reader) => reader.size(),
            FormatReader::Aedat4(reader) => reader.size(),
        }
    }

    fn next_event(&mut self) -> Result<Option<PixelEvent>, EventFileError> {
        let (event, at) = match &mut self.reader {
            FormatReader::Evt(reader) => (reader.next_event()?, reader.event_place()),
            FormatReader::Aedat4(reader) => (reader.next_event()?, reader.event_place()),
        };
        event.map(|event| self.checked(event, at)).transpose()
    }

    /// Refuses an event outside of the sensor. It is `at` this place in the file.
    fn checked(&self, event: PixelEvent, at: u64) -> Result<PixelEvent, EventFileError> {
        let side = self.format().max_side();
        let (width, height) = self.size().unwrap_or((side, side));
        let (x, y) = (u32::from(event.x), u32::from(event.y));
        if x < width && y < height {
            return Ok(event);
        }
        let problem = format!(
            "an event of pixel ({x}, {y}) is outside of the sensor, which has {width}x{height} pixels; the file \
             may be damaged"
        );
        Err(EventFileError::Stream { at, problem })
    }
}

impl<R: BufRead> Iterator for EventReader<R> {
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
