// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory outside of a core: a queue of the words that were given to it, which now and then fails.

use std::collections::VecDeque;

use foveate_model::RasterOutput;

use super::recipe::RasterRecipe;
use crate::frames::Random;

/// How often, of a thousand words that are asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Faults {
    /// None is valid, and the word comes one later, or never.
    pub(crate) missing: i64,
    /// It is valid and wrong.
    pub(crate) wrong: i64,
}

impl Faults {
    pub(crate) const NONE: Self = Self { missing: 0, wrong: 0 };
}

pub(crate) struct Memory {
    is_there: bool,
    pixels: i64,
    top: i64,
    faults: Faults,
    random: Random,
    queue: VecDeque<Vec<u16>>,
}

impl Memory {
    pub(crate) fn new(recipe: &RasterRecipe, faults: Faults, seed: u64) -> Self {
        let (is_there, pixels) = (recipe.is_outside(), recipe.pixels);
        let (top, random) = (recipe.base.pixel_max() + 1, Random(seed ^ 0x5eed));
        Self { is_there, pixels, top, faults, random, queue: VecDeque::new() }
    }

    pub(crate) fn forget(&mut self) {
        self.queue.clear();
    }

    /// What is at the ports of references at the next edge, where the outputs show this before it.
    pub(crate) fn show(&mut self, before: &RasterOutput) -> (bool, Vec<u16>) {
        if !self.is_there {
            return (self.random.below(2) > 0, Vec::new());
        }
        if !before.reference_ready {
            // Nobody may look at it.
            return (self.random.below(2) > 0, self.junk());
        }
        let chance = self.random.below(1000);
        if chance < self.faults.missing {
            if chance % 2 == 0 {
                self.queue.pop_front();
            }
            return (false, self.junk());
        }
        match self.queue.pop_front() {
            None => (false, self.junk()),
            Some(_) if chance < self.faults.missing + self.faults.wrong => (true, self.junk()),
            Some(word) => (true, word),
        }
    }

    /// The outputs show this after an edge.
    pub(crate) fn store(&mut self, after: &RasterOutput) {
        if after.store_valid {
            self.queue.push_back(after.store_pixels.clone());
        }
    }

    fn junk(&mut self) -> Vec<u16> {
        (0..self.pixels).map(|_| self.random.below(self.top) as u16).collect()
    }
}
