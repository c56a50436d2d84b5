// SPDX-License-Identifier: MIT OR Apache-2.0
//! The position of the core in a frame: the word that each advance brings, and whether the next
//! advance waits for the port.

use foveate_design::RasterTiming;

/// A counter of the advances of a frame, from 0.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AdvanceCounter {
    timing: RasterTiming,
    /// The number of the next advance.
    next: u64,
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

impl AdvanceCounter {
    pub(super) fn new(timing: RasterTiming) -> Self {
        Self { timing, next: 0 }
    }

    /// Resets the counter: the next advance is the first of a frame.
    pub(super) fn reset(&mut self) {
        self.next = 0;
    }

    /// Returns true if the next advance is the first of a frame.
    pub(super) fn is_between_frames(&self) -> bool {
        self.next == 0
    }

    /// Returns true if the next advance takes a word, so that it waits for one.
    pub(super) fn takes_next(&self) -> bool {
        self.position(self.next).is_some_and(|place| self.is_taken(place))
    }

    /// Applies one edge, and returns its advance. `takes` is true if the edge takes a word. There
    /// is no advance if the next one waits for a word.
    pub(super) fn step(&mut self, takes: bool) -> Option<Advance> {
        if self.takes_next() && !takes {
            return None;
        }
        let number = self.next;
        let word = self.position(number);
        self.next = (number + 1) % self.timing.advances();
        let last =
            WordPosition { row: self.timing.taken_rows - 1, column: self.timing.taken_words - 1 };
        Some(Advance {
            word,
            tail: number.checked_sub(self.timing.tail_delay()).and_then(|tail| self.position(tail)),
            is_last_taken: word == Some(last),
        })
    }

    /// Returns true if a word of the padded frame is a word of the frame itself.
    fn is_taken(&self, place: WordPosition) -> bool {
        place.column < self.timing.taken_words && place.row < self.timing.taken_rows
    }

    /// Returns the position of word `number` of the padded frame, or `None` beyond its end.
    fn position(&self, number: u64) -> Option<WordPosition> {
        let length = u64::from(self.timing.row_words);
        let narrow = |value| u32::try_from(value).expect("a row and a column have 32 bits");
        (number < self.timing.words())
            .then(|| WordPosition { row: narrow(number / length), column: narrow(number % length) })
    }
}
