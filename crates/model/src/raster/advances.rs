// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where in a frame the core is: which word each advance brings, and whether the next one waits for the port.

use foveate_design::RasterTiming;

/// The advances of a frame, numbered from 0.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Advances {
    timing: RasterTiming,
    /// The number of the next.
    next: u64,
}

/// What an advance brings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Advance {
    /// The word of the padded frame that comes in; none while the windows are flushed.
    pub(super) word: Option<Place>,
    /// The word that comes to the tail; none while the windows are filled.
    pub(super) tail: Option<Place>,
    /// Whether it takes the last word of a frame: its edge is T0.
    pub(super) is_last_taken: bool,
}

/// A word of the padded frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Row of pixels.
    pub(super) row: u32,
    /// Number of the word in its row.
    pub(super) column: u32,
}

impl Advances {
    pub(super) fn new(timing: RasterTiming) -> Self {
        Self { timing, next: 0 }
    }

    /// The next advance is the first of a frame.
    pub(super) fn forget(&mut self) {
        self.next = 0;
    }

    /// Whether the next advance is the first of a frame.
    pub(super) fn is_between_frames(&self) -> bool {
        self.next == 0
    }

    /// Whether the next advance takes a word, and so waits for one.
    pub(super) fn takes_next(&self) -> bool {
        self.place(self.next).is_some_and(|place| self.is_taken(place))
    }

    /// One edge; `takes` says whether it takes a word. Nothing happens where the next advance waits for one.
    pub(super) fn step(&mut self, takes: bool) -> Option<Advance> {
        if self.takes_next() && !takes {
            return None;
        }
        let number = self.next;
        let word = self.place(number);
        self.next = (number + 1) % self.timing.advances();
        let last = Place { row: self.timing.taken_rows - 1, column: self.timing.taken_words - 1 };
        Some(Advance {
            word,
            tail: number.checked_sub(self.timing.tail_delay()).and_then(|tail| self.place(tail)),
            is_last_taken: word == Some(last),
        })
    }

    /// Whether a word of the padded frame is a word of the frame itself.
    fn is_taken(&self, place: Place) -> bool {
        place.column < self.timing.taken_words && place.row < self.timing.taken_rows
    }

    /// Where word `number` of the padded frame is; none beyond its end.
    fn place(&self, number: u64) -> Option<Place> {
        let length = u64::from(self.timing.row_words);
        let narrow = |value| u32::try_from(value).expect("a row and a column have 32 bits");
        (number < self.timing.words())
            .then(|| Place { row: narrow(number / length), column: narrow(number % length) })
    }
}
