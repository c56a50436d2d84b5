// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words of EVT 3.0, which have 16 bits: the type in the highest four. A word states a row, a
//! pixel, the start of a vector or a part of the time, and the other fields keep their values. A
//! vector has a bit for each of 12 or 8 pixels in a row.

use super::time_base::{TimeBaseDecoder, TimeBaseEncoder};
use crate::events::PixelEvent;

/// The row of the following events.
const ROW: u16 = 0x0;
/// An event: its column, and its polarity in bit 11.
const PIXEL: u16 = 0x2;
/// The first column of the following vectors, and their polarity in bit 11.
const VECTOR_START: u16 = 0x3;
/// A vector of 12 pixels, after which the next one begins.
const VECTOR_12: u16 = 0x4;
/// A vector of 8 pixels, after which the next one begins.
const VECTOR_8: u16 = 0x5;
/// The low part of times.
const TIME_LOW: u16 = 0x6;
/// The high part of times.
const TIME_HIGH: u16 = 0x8;
/// The bits of a word without its type: of each part of a time, and of a vector.
const CONTENT_BITS: u32 = 12;
const CONTENT: u16 = (1 << CONTENT_BITS) - 1;
/// The bits of a coordinate.
const SIDE: u16 = (1 << 11) - 1;
/// The bit of a polarity.
const POLARITY: u16 = 1 << 11;
const VECTOR_PIXELS: u16 = 12;
/// The least number of events of a first vector, which takes two words.
const MIN_VECTOR_EVENTS: usize = 3;

/// Makes words of events. The last events of a row wait until it is known how many there are.
#[derive(Clone, Debug)]
pub(crate) struct Evt3Encoder {
    base: TimeBaseEncoder,
    /// The low part of times that the last word stated.
    time_low: Option<u64>,
    row: Option<u16>,
    /// Events of one row, time and polarity, from left to right.
    waiting: Vec<PixelEvent>,
}

impl Evt3Encoder {
    pub(crate) fn new() -> Self {
        let base = TimeBaseEncoder::new(CONTENT_BITS);
        Self { base, time_low: None, row: None, waiting: Vec::new() }
    }

    /// Appends the words of the events that wait, unless the event continues them. It is not
    /// earlier than the last one.
    pub(crate) fn push(&mut self, event: PixelEvent, words: &mut Vec<u8>) {
        let continues = self.waiting.last().is_none_or(|last| {
            (last.y, last.time_us, last.is_brighter) == (event.y, event.time_us, event.is_brighter)
                && last.x < event.x
        });
        if !continues {
            self.flush(words);
        }
        self.waiting.push(event);
    }

    /// Appends the words of the events that wait.
    pub(crate) fn flush(&mut self, words: &mut Vec<u8>) {
        let Some(&PixelEvent { y, time_us, is_brighter, .. }) = self.waiting.first() else {
            return;
        };
        let mut append =
            |kind: u16, content: u16| words.extend((kind << CONTENT_BITS | content).to_le_bytes());
        self.state_time(time_us, &mut append);
        if self.row != Some(y) {
            append(ROW, y);
            self.row = Some(y);
        }
        let polarity = if is_brighter { POLARITY } else { 0 };
        let mut left = self.waiting.as_slice();
        // The column at which a vector would begin without a word for its start.
        let mut next_vector = None;
        while let Some(first) = left.first() {
            let start = next_vector.filter(|&start| first.x < start + VECTOR_PIXELS);
            let from = start.unwrap_or(first.x);
            let count = left.partition_point(|event| event.x < from + VECTOR_PIXELS);
            if start.is_none() && count < MIN_VECTOR_EVENTS {
                append(PIXEL, first.x | polarity);
                left = &left[1..];
                next_vector = None;
                continue;
            }
            if start.is_none() {
                append(VECTOR_START, from | polarity);
            }
            let (events, rest) = left.split_at(count);
            append(VECTOR_12, events.iter().fold(0, |bits, event| bits | 1 << (event.x - from)));
            (left, next_vector) = (rest, Some(from + VECTOR_PIXELS));
        }
        self.waiting.clear();
    }

    /// Appends the words of a time, if it is a new one.
    fn state_time(&mut self, time_us: u64, append: &mut impl FnMut(u16, u16)) {
        let part = |value: u64| u16::try_from(value).expect("a part has 12 bits");
        let (high, low) = (time_us >> CONTENT_BITS, time_us & u64::from(CONTENT));
        if self.base.high() != Some(high) {
            self.base.advance(high, true, |high| append(TIME_HIGH, part(high)));
            self.time_low = None;
        }
        if self.time_low != Some(low) {
            append(TIME_LOW, part(low));
            // A reader that enters the stream here finds a row.
            (self.time_low, self.row) = (Some(low), None);
        }
    }
}

/// Makes events of words.
#[derive(Clone, Debug)]
pub(crate) struct Evt3Decoder {
    base: TimeBaseDecoder,
    time_low: u16,
    row: Option<u16>,
    /// The column of the next vector.
    vector_start: u16,
    is_vector_brighter: bool,
    /// The pixels of a vector whose events were not taken yet, and its first column.
    vector: u16,
    vector_column: u16,
}

impl Evt3Decoder {
    pub(crate) fn new() -> Self {
        Self {
            base: TimeBaseDecoder::new(CONTENT_BITS),
            time_low: 0,
            row: None,
            vector_start: 0,
            is_vector_brighter: false,
            vector: 0,
            vector_column: 0,
        }
    }

    pub(crate) fn next_of_vector(&mut self) -> Option<PixelEvent> {
        if self.vector == 0 {
            return None;
        }
        let pixel = self.vector.trailing_zeros();
        self.vector &= self.vector - 1;
        let pixel = u16::try_from(pixel).expect("it is below 12");
        // A column beyond the row is refused by the reader.
        self.event(self.vector_column.saturating_add(pixel), self.is_vector_brighter)
    }

    /// Takes a word. Returns the event of a single pixel; those of a vector follow from
    /// [`Evt3Decoder::next_of_vector`]. Events before the first row and time are left out. Triggers
    /// and words of a vendor have no event.
    pub(crate) fn take(&mut self, word: u16) -> Option<PixelEvent> {
        let content = word & CONTENT;
        let is_brighter = content & POLARITY != 0;
        match word >> CONTENT_BITS {
            ROW => self.row = Some(content & SIDE),
            PIXEL => return self.event(content & SIDE, is_brighter),
            VECTOR_START => {
                (self.vector_start, self.is_vector_brighter) = (content & SIDE, is_brighter);
            }
            VECTOR_12 => self.begin_vector(content, VECTOR_PIXELS),
            VECTOR_8 => self.begin_vector(content & 0xff, 8),
            TIME_LOW => self.time_low = content,
            TIME_HIGH => self.base.take(content.into()),
            _ => {}
        }
        None
    }

    fn begin_vector(&mut self, pixels: u16, length: u16) {
        let is_placed = self.row.is_some() && self.base.high().is_some();
        (self.vector, self.vector_column) = (if is_placed { pixels } else { 0 }, self.vector_start);
        // A stream of damaged words may have more vectors than a row has room for.
        self.vector_start = self.vector_start.saturating_add(length);
    }

    fn event(&self, x: u16, is_brighter: bool) -> Option<PixelEvent> {
        let (y, high) = self.row.zip(self.base.high())?;
        let time_us = high << CONTENT_BITS | u64::from(self.time_low);
        Some(PixelEvent { x, y, time_us, is_brighter })
    }
}
