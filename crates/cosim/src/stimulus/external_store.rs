// SPDX-License-Identifier: MIT OR Apache-2.0
//! An external frame store: it returns in the next frame the words that the core stores. It may
//! lack the word that the core asks for, or return a wrong one.

use super::random::Random;
use super::unused_inputs::UnusedInputs;
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;
use std::collections::VecDeque;

/// One in so many words is wrong.
const WRONG_WORD_PERIOD: u64 = 5;

/// A fault of the frame store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StoreFault {
    /// No fault.
    None,
    /// Some words are late by one request, so all words after one are off by one.
    Late,
    /// Some words are missing and never come.
    Missing,
    /// The word with this index, counted from the first one that the core asks for, comes without
    /// its valid bit.
    UnmarkedWord(u64),
    /// Some words are wrong.
    Wrong,
}

/// An external frame store with a fault.
pub(super) struct ExternalStore {
    /// The words that were stored and not yet returned, the oldest first.
    words: VecDeque<Vec<u16>>,
    fault: StoreFault,
    /// The indices of the words that are late, missing or unmarked, counted from the first word
    /// that the core asks for.
    missing: [u64; 2],
    /// The number of words that the core has asked for since reset.
    requested_words: u64,
    random: Random,
    unused: UnusedInputs,
    timing: RasterTiming,
    max: u16,
}

impl ExternalStore {
    /// Returns the store, or `None` if the core stores its own references.
    pub(super) fn for_design(
        design: &Design,
        unused: UnusedInputs,
        random: Random,
    ) -> Option<Self> {
        let design = match design.hardware() {
            Hardware::Raster(own) => design.with_hardware(own),
            Hardware::Pipelined(_) | Hardware::Serial(_) => return None,
        };
        design.has_external_store().then(|| Self {
            words: VecDeque::new(),
            fault: StoreFault::None,
            missing: [0; 2],
            requested_words: 0,
            random,
            unused,
            timing: RasterTiming::from_design(design),
            max: u16::try_from(design.pixel_max()).expect("a pixel has at most 16 bits"),
        })
    }

    /// Empties the store for a reset, and sets its fault from now on.
    pub(super) fn begin(&mut self, fault: StoreFault) {
        self.words.clear();
        self.fault = fault;
        self.requested_words = 0;
        let (row, words) = (u64::from(self.timing.row_words), self.timing.words());
        // One word is missing at the ends of rows and frames, and one anywhere in the second frame
        // with references.
        let places = [0, 1, row - 1, row, words - 1, words];
        let directed = places[self.random.index(places.len() - 1)];
        self.missing = match fault {
            StoreFault::UnmarkedWord(word) => [word; 2],
            StoreFault::None | StoreFault::Late | StoreFault::Missing | StoreFault::Wrong => {
                [directed, words + self.random.up_to(words - 1)]
            }
        };
    }

    /// Returns the valid bit and the word at the reference ports for the next edge; `before` is the
    /// core before that edge.
    pub(super) fn output_word(&mut self, before: &dyn CycleModel) -> (bool, Vec<u16>) {
        if !before.is_high(PortRole::ReferenceReady) {
            return self.unused_output();
        }
        let is_missing = self.missing.contains(&self.requested_words);
        self.requested_words += 1;
        let word = match self.fault {
            StoreFault::Late if is_missing => None,
            StoreFault::Missing if is_missing => {
                self.words.pop_front();
                None
            }
            StoreFault::UnmarkedWord(_) if is_missing => {
                let word = self.words.pop_front();
                return (false, word.unwrap_or_else(|| self.unused_word()));
            }
            StoreFault::None
            | StoreFault::Late
            | StoreFault::Missing
            | StoreFault::UnmarkedWord(_)
            | StoreFault::Wrong => self.words.pop_front(),
        };
        let is_wrong = self.fault == StoreFault::Wrong && self.random.one_in(WRONG_WORD_PERIOD);
        match word {
            Some(word) => (true, if is_wrong { self.unused_word() } else { word }),
            None => (false, self.unused_word()),
        }
    }

    /// Returns the valid bit and a word that the core must not use.
    fn unused_output(&mut self) -> (bool, Vec<u16>) {
        let oldest = self.words.front().cloned();
        let is_valid = match self.unused {
            UnusedInputs::Random => self.random.one_in(2),
            UnusedInputs::Constant { .. } => oldest.is_some(),
        };
        let word = oldest.filter(|_| self.unused.bit(&mut self.random));
        (is_valid, word.unwrap_or_else(|| self.unused_word()))
    }

    /// Stores the word that the core outputs after an edge, if there is one.
    pub(super) fn store_output(&mut self, after: &dyn CycleModel) {
        if after.is_high(PortRole::StoreValid) {
            let mut word = Vec::new();
            after.append_output(PortRole::StorePixel, &mut word);
            let pixel = |value| u16::try_from(value).expect("a pixel has at most 16 bits");
            self.words.push_back(word.into_iter().map(pixel).collect());
        }
    }

    fn unused_word(&mut self) -> Vec<u16> {
        self.unused.pixels(self.timing.word_pixels as usize, self.max, &mut self.random)
    }
}
