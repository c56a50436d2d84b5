// SPDX-License-Identifier: MIT OR Apache-2.0
//! An external frame store that sometimes lacks the word that the core asks for, or returns a wrong
//! one.

use super::random::Random;
use super::store_queue::StoreQueue;
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;

/// One in `WRONG` words is wrong.
const WRONG_WORD_PERIOD: u64 = 5;

/// A fault of the frame store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StoreFault {
    /// No fault.
    None,
    /// Some words are late by one request, so all words after one are off by one.
    Late,
    /// Some words are missing and never come.
    Missing,
    /// Some words are wrong.
    Wrong,
}

/// An external frame store with a fault.
pub(super) struct FaultyStore {
    queue: StoreQueue,
    fault: StoreFault,
    /// The indices of the words that are late or missing, counted from the first word that the core
    /// asks for.
    missing: [u64; 2],
    /// The number of words that the core has asked for since reset.
    requested_words: u64,
    random: Random,
    timing: RasterTiming,
    max: u16,
}

impl FaultyStore {
    /// Returns the store, or `None` if the core stores its own references; then nothing is drawn
    /// from `random`.
    pub(super) fn for_design(design: &Design, max: u16, random: &mut Random) -> Option<Self> {
        let design = match design.hardware() {
            Hardware::Raster(own) => design.with_hardware(own),
            Hardware::Pipelined(_) | Hardware::Serial(_) => return None,
        };
        design.has_external_store().then(|| Self {
            queue: StoreQueue::default(),
            fault: StoreFault::None,
            missing: [0; 2],
            requested_words: 0,
            random: random.fork(),
            timing: RasterTiming::from_design(design),
            max,
        })
    }

    /// Empties the store for a reset, and sets its fault from now on.
    pub(super) fn begin(&mut self, lapse: StoreFault) {
        self.queue.clear();
        self.fault = lapse;
        self.requested_words = 0;
        let (row, words) = (u64::from(self.timing.row_words), self.timing.words());
        // One word is missing at the ends of rows and frames, and one anywhere in the second frame
        // with references.
        let places = [0, 1, row - 1, row, words - 1, words];
        let directed = places[self.random.index(places.len() - 1)];
        self.missing = [directed, words + self.random.up_to(words - 1)];
    }

    /// Returns the valid bit and the word at the reference ports for the next edge; `before` is the
    /// core before that edge.
    pub(super) fn output_word(&mut self, before: &dyn CycleModel) -> (bool, Vec<u16>) {
        let oldest = self.queue.oldest().map(<[u16]>::to_vec);
        if !before.is_high(PortRole::ReferenceReady) {
            // The core must not use this word.
            let word = oldest.filter(|_| self.random.one_in(2));
            return (self.random.one_in(2), word.unwrap_or_else(|| self.garbage()));
        }
        let is_missing = self.missing.contains(&self.requested_words);
        self.requested_words += 1;
        let Some(word) = oldest else { return (false, self.garbage()) };
        match self.fault {
            StoreFault::Late if is_missing => return (false, self.garbage()),
            StoreFault::Missing if is_missing => {
                self.queue.pop();
                return (false, self.garbage());
            }
            StoreFault::None | StoreFault::Late | StoreFault::Missing | StoreFault::Wrong => {
                self.queue.pop();
            }
        }
        let is_wrong = self.fault == StoreFault::Wrong && self.random.one_in(WRONG_WORD_PERIOD);
        (true, if is_wrong { self.garbage() } else { word })
    }

    /// Stores the word that the core outputs after an edge.
    pub(super) fn store_output(&mut self, after: &dyn CycleModel) {
        self.queue.store_output(after);
    }

    fn garbage(&mut self) -> Vec<u16> {
        (0..self.timing.word_pixels).map(|_| self.random.pixel(self.max)).collect()
    }
}
