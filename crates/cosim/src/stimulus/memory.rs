// SPDX-License-Identifier: MIT OR Apache-2.0
//! An external frame store that sometimes lacks the word that the core asks for, or returns a wrong
//! one.

use super::queue::Queue;
use super::random::Random;
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;

/// One in `WRONG` words is wrong.
const WRONG: u64 = 5;

/// A fault of the frame store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lapse {
    /// No fault.
    None,
    /// Some words are late by one request, so all words after one are off by one.
    Late,
    /// Some words are missing and never come.
    Gone,
    /// Some words are wrong.
    Wrong,
}

/// An external frame store with a fault.
pub(super) struct Memory {
    queue: Queue,
    lapse: Lapse,
    /// The indices of the words that are late or missing, counted from the first word that the core
    /// asks for.
    missing: [u64; 2],
    /// The number of words that the core has asked for since reset.
    asked: u64,
    random: Random,
    timing: RasterTiming,
    max: u16,
}

impl Memory {
    /// Returns the store, or `None` if the core stores its own references; then nothing is drawn
    /// from `random`.
    pub(super) fn of(design: &Design, max: u16, random: &mut Random) -> Option<Self> {
        let design = match design.hardware() {
            Hardware::Raster(own) => design.on(own),
            Hardware::Pipelined(_) | Hardware::Serial(_) => return None,
        };
        design.frames_are_kept_outside().then(|| Self {
            queue: Queue::default(),
            lapse: Lapse::None,
            missing: [0; 2],
            asked: 0,
            random: random.fork(),
            timing: RasterTiming::of(design),
            max,
        })
    }

    /// Empties the store for a reset, and sets its fault from now on.
    pub(super) fn begin(&mut self, lapse: Lapse) {
        self.queue.forget();
        self.lapse = lapse;
        self.asked = 0;
        let (row, words) = (u64::from(self.timing.row_words), self.timing.words());
        // One word is missing at the ends of rows and frames, and one anywhere in the second frame
        // with references.
        let places = [0, 1, row - 1, row, words - 1, words];
        let directed = places[self.random.index(places.len() - 1)];
        self.missing = [directed, words + self.random.up_to(words - 1)];
    }

    /// Returns the valid bit and the word at the reference ports for the next edge; `before` is the
    /// core before that edge.
    pub(super) fn show(&mut self, before: &dyn CycleModel) -> (bool, Vec<u16>) {
        let oldest = self.queue.oldest().map(<[u16]>::to_vec);
        if !before.is_high(PortRole::ReferenceReady) {
            // The core must not use this word.
            let word = oldest.filter(|_| self.random.one_in(2));
            return (self.random.one_in(2), word.unwrap_or_else(|| self.garbage()));
        }
        let is_missing = self.missing.contains(&self.asked);
        self.asked += 1;
        let Some(word) = oldest else { return (false, self.garbage()) };
        match self.lapse {
            Lapse::Late if is_missing => return (false, self.garbage()),
            Lapse::Gone if is_missing => {
                self.queue.pop();
                return (false, self.garbage());
            }
            Lapse::None | Lapse::Late | Lapse::Gone | Lapse::Wrong => self.queue.pop(),
        }
        let is_wrong = self.lapse == Lapse::Wrong && self.random.one_in(WRONG);
        (true, if is_wrong { self.garbage() } else { word })
    }

    /// Stores the word that the core outputs after an edge.
    pub(super) fn keep(&mut self, after: &dyn CycleModel) {
        self.queue.keep(after);
    }

    fn garbage(&mut self) -> Vec<u16> {
        (0..self.timing.word_pixels).map(|_| self.random.pixel(self.max)).collect()
    }
}
