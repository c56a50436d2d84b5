// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory outside of a core, which sometimes has not the word that the core asks for, or another.

use super::queue::Queue;
use super::random::Random;
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;

/// A wrong word comes once in so many.
const WRONG: u64 = 5;

/// What a memory does wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lapse {
    /// Nothing.
    None,
    /// Now and then it has no word, and that comes at the next edge: all that follow are off by one.
    Late,
    /// Now and then it has no word, which never comes.
    Gone,
    /// Some of its words are others.
    Wrong,
}

/// The memory.
pub(super) struct Memory {
    queue: Queue,
    lapse: Lapse,
    /// The numbers of the words that are late or gone, counted from the first that the core asks for.
    missing: [u64; 2],
    /// Words that the core has asked for since reset.
    asked: u64,
    random: Random,
    timing: RasterTiming,
    max: u16,
}

impl Memory {
    /// None where the frame store is inside, so that nothing is drawn.
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

    /// A reset: it is empty, and from here on fails like this.
    pub(super) fn begin(&mut self, lapse: Lapse) {
        self.queue.forget();
        self.lapse = lapse;
        self.asked = 0;
        let (row, words) = (u64::from(self.timing.row_words), self.timing.words());
        // At the ends of rows and frames, and anywhere in the second frame with references.
        let places = [0, 1, row - 1, row, words - 1, words];
        let directed = places[self.random.index(places.len() - 1)];
        self.missing = [directed, words + self.random.up_to(words - 1)];
    }

    /// What is at the ports of references at the next edge, where the core shows this before it.
    pub(super) fn show(&mut self, before: &dyn CycleModel) -> (bool, Vec<u16>) {
        let oldest = self.queue.oldest().map(<[u16]>::to_vec);
        if !before.is_high(PortRole::ReferenceReady) {
            // Nobody may look at it.
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

    /// Keeps what the core shows after an edge.
    pub(super) fn keep(&mut self, after: &dyn CycleModel) {
        self.queue.keep(after);
    }

    fn garbage(&mut self) -> Vec<u16> {
        (0..self.timing.word_pixels).map(|_| self.random.pixel(self.max)).collect()
    }
}
