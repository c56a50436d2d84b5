// SPDX-License-Identifier: MIT OR Apache-2.0
//! A model of the external memory of a core: a queue of the words that the core stored, which fails
//! occasionally.

use std::collections::VecDeque;

use foveate_model::RasterOutput;

use super::raster_parameters::RasterParameters;
use crate::frames::SeededRandom;

/// The rates of faults, per thousand words that the core asks for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MemoryFaultRates {
    /// No word is valid. The word comes one later, or never.
    pub(crate) missing: i64,
    /// The word is valid and wrong.
    pub(crate) wrong: i64,
}

impl MemoryFaultRates {
    pub(crate) const NONE: Self = Self { missing: 0, wrong: 0 };
}

pub(crate) struct ExternalMemory {
    is_present: bool,
    pixels: i64,
    top: i64,
    faults: MemoryFaultRates,
    random: SeededRandom,
    queue: VecDeque<Vec<u16>>,
}

impl ExternalMemory {
    pub(crate) fn new(recipe: &RasterParameters, faults: MemoryFaultRates, seed: u64) -> Self {
        let (is_there, pixels) = (recipe.has_external_store(), recipe.word_pixels);
        let (top, random) = (recipe.base.pixel_max() + 1, SeededRandom(seed ^ 0x5eed));
        Self { is_present: is_there, pixels, top, faults, random, queue: VecDeque::new() }
    }

    pub(crate) fn clear(&mut self) {
        self.queue.clear();
    }

    /// Returns the reference port at the next edge, for the outputs before it.
    pub(crate) fn reference_port(&mut self, before: &RasterOutput) -> (bool, Vec<u16>) {
        if !self.is_present {
            return (self.random.below(2) > 0, Vec::new());
        }
        if !before.reference_ready {
            // The core must ignore this value.
            return (self.random.below(2) > 0, self.random_word());
        }
        let chance = self.random.below(1000);
        if chance < self.faults.missing {
            if chance % 2 == 0 {
                self.queue.pop_front();
            }
            return (false, self.random_word());
        }
        match self.queue.pop_front() {
            None => (false, self.random_word()),
            Some(_) if chance < self.faults.missing + self.faults.wrong => {
                (true, self.random_word())
            }
            Some(word) => (true, word),
        }
    }

    /// Stores the word of the outputs after an edge, if there is one.
    pub(crate) fn store(&mut self, after: &RasterOutput) {
        if after.store_valid {
            self.queue.push_back(after.store_pixels.clone());
        }
    }

    fn random_word(&mut self) -> Vec<u16> {
        (0..self.pixels).map(|_| self.random.below(self.top) as u16).collect()
    }
}
