// SPDX-License-Identifier: MIT OR Apache-2.0
//! What comes into a core: the position of each word in its frame ([`AdvanceCounter`]), and the
//! padded frame, word by word ([`IncomingFrame`]).

use crate::region::black_padded_frame;
use foveate_design::{RasterDesign, RasterTiming};
use foveate_pixels::Frame;

/// A counter of the advances of a frame, from 0.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AdvanceCounter {
    timing: RasterTiming,
    next: u64,
    /// The words that come in.
    incoming: WordScan,
    /// The words that come to the tail.
    tail: WordScan,
}

/// The words that an advance moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Advance {
    /// The word of the padded frame that comes in, or `None` while the windows are flushed.
    pub(super) word: Option<WordPosition>,
    /// The word that comes to the tail, or `None` while the windows are filled.
    pub(super) tail: Option<WordPosition>,
    /// True if the advance takes the last word of a frame, so that its edge is T0.
    pub(super) is_last_taken: bool,
}

/// The position of a word in the padded frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct WordPosition {
    /// Row of pixels.
    pub(super) row: u32,
    /// Number of the word in its row.
    pub(super) column: u32,
}

/// A scan of the words of the padded frame, row by row.
#[derive(Clone, Debug, PartialEq)]
struct WordScan {
    row_words: u32,
    rows: u32,
    /// The position of the next word. Its row is `rows` beyond the end of the frame.
    next: WordPosition,
}

impl AdvanceCounter {
    pub(super) fn new(timing: RasterTiming) -> Self {
        let scan = WordScan::from_timing(&timing);
        Self { timing, next: 0, incoming: scan.clone(), tail: scan }
    }

    /// Resets the counter: the next advance is the first of a frame.
    pub(super) fn reset(&mut self) {
        *self = Self::new(self.timing);
    }

    pub(super) fn is_between_frames(&self) -> bool {
        self.next == 0
    }

    /// Returns true if the next advance takes a word, so that it waits for one.
    pub(super) fn takes_next(&self) -> bool {
        self.incoming.next_word().is_some_and(|place| self.is_taken(place))
    }

    /// Applies one edge, and returns its advance. `takes` is true if the edge takes a word. There
    /// is no advance if the next one waits for a word.
    pub(super) fn step(&mut self, takes: bool) -> Option<Advance> {
        if self.takes_next() && !takes {
            return None;
        }
        let last =
            WordPosition { row: self.timing.taken_rows - 1, column: self.timing.taken_words - 1 };
        let word = self.incoming.step();
        let reaches_tail = self.next >= self.timing.tail_delay();
        let tail = if reaches_tail { self.tail.step() } else { None };
        self.next += 1;
        if self.next == self.timing.advances() {
            self.reset();
        }
        Some(Advance { word, tail, is_last_taken: word == Some(last) })
    }

    /// Returns true if a word of the padded frame is a word of the frame itself.
    fn is_taken(&self, place: WordPosition) -> bool {
        place.column < self.timing.taken_words && place.row < self.timing.taken_rows
    }
}

impl WordScan {
    fn from_timing(timing: &RasterTiming) -> Self {
        let first = WordPosition { row: 0, column: 0 };
        Self { row_words: timing.row_words, rows: timing.rows, next: first }
    }

    /// Returns the position of the next word, or `None` beyond the end of the frame.
    fn next_word(&self) -> Option<WordPosition> {
        (self.next.row < self.rows).then_some(self.next)
    }

    /// Returns the position of the next word, and goes on to the word after it.
    fn step(&mut self) -> Option<WordPosition> {
        let word = self.next_word()?;
        let WordPosition { row, column } = word;
        let is_last = column + 1 == self.row_words;
        self.next = if is_last {
            WordPosition { row: row + 1, column: 0 }
        } else {
            WordPosition { row, column: column + 1 }
        };
        Some(word)
    }
}

/// The raw pixels of the current frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct IncomingFrame {
    padded: Frame,
    /// Width of the frame without padding.
    width: u32,
    height: u32,
    /// Number of pixels of a word, K.
    word_pixels: u32,
}

impl IncomingFrame {
    pub(super) fn new(design: RasterDesign<'_>) -> Self {
        Self {
            padded: black_padded_frame(&design),
            width: design.width(),
            height: design.height(),
            word_pixels: design.pixels_per_clock(),
        }
    }

    /// Returns the padded frame, as far as it has come in.
    pub(super) fn padded(&self) -> &Frame {
        &self.padded
    }

    /// Writes a word, in the order of the advances. `port` is used only for pixels of the frame
    /// itself.
    pub(super) fn write(&mut self, place: WordPosition, port: &[u16]) {
        let y = place.row;
        for (x, &own) in (place.column * self.word_pixels..).zip(port) {
            let is_inside = x < self.width && y < self.height;
            let pixel = if is_inside { own } else { self.nearest_pixel(x, y) };
            self.padded.set(x, y, pixel);
        }
    }

    /// Returns the pixel of the frame that is nearest to (x, y). It has come in before.
    fn nearest_pixel(&self, x: u32, y: u32) -> u16 {
        self.padded.get(x.min(self.width - 1), y.min(self.height - 1))
    }
}
