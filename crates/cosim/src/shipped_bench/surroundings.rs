// SPDX-License-Identifier: MIT OR Apache-2.0
//! The surroundings of a core in a bench: a sink that stalls, and an external frame store that
//! returns what was stored.

use super::script::MIN_FRAMES_PER_SCRIPT;
use crate::stimulus::{StoreQueue, is_region_end_leaving};
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;

/// The number of losses after which the sink takes nothing any more. Lost counters then count on,
/// and the vectors of a large frame stay small.
const ENOUGH_LOSSES: u64 = 64;

/// A sink that stalls from the last word of a region on, once the first word of the next region has
/// been fetched, until a region is lost. At every second loss it takes a word at the edge of the
/// loss.
pub(super) struct StallingSink {
    is_ready: bool,
    /// True if the sink has already stalled for the last word that is on the ports.
    has_stalled: bool,
    losses: u64,
}

impl Default for StallingSink {
    fn default() -> Self {
        Self { is_ready: true, has_stalled: false, losses: 0 }
    }
}

impl StallingSink {
    /// Returns true if the sink takes a word at the next edge.
    pub(super) fn is_ready_next(&mut self, core: &dyn CycleModel) -> bool {
        if self.losses == ENOUGH_LOSSES {
            return false;
        }
        let ends = is_region_end_leaving(core);
        if core.will_abort() {
            self.losses += 1;
            let takes = self.losses.is_multiple_of(2);
            (self.is_ready, self.has_stalled) = (true, ends && !takes);
            return takes;
        }
        if self.is_ready && ends {
            self.is_ready = std::mem::take(&mut self.has_stalled);
        }
        self.is_ready
    }
}

/// An external frame store: a queue without delay.
pub(super) struct ExternalStore {
    queue: StoreQueue,
    /// The word that is shown while no word is valid.
    idle_word: Vec<u16>,
    /// The number of words taken since reset.
    taken_words: u64,
    /// The index of the word that is stored but not marked as valid: the last word of the frames
    /// that every script has. So the bench sees an underrun, and all decisions of its frames use
    /// correct references.
    withheld_word: u64,
}

impl ExternalStore {
    /// Returns the store, or `None` if the core stores its own references.
    pub(super) fn for_design(part: &Design) -> Option<Self> {
        let part = match part.hardware() {
            Hardware::Raster(own) => part.with_hardware(own),
            Hardware::Pipelined(_) | Hardware::Serial(_) => return None,
        };
        part.has_external_store().then(|| Self {
            queue: StoreQueue::default(),
            idle_word: vec![0; part.pixels_per_clock() as usize],
            taken_words: 0,
            withheld_word: (MIN_FRAMES_PER_SCRIPT - 1) * RasterTiming::from_design(part).words()
                - 1,
        })
    }

    /// Returns the valid bit and the word at the reference ports for the next edge, which may be a
    /// reset.
    pub(super) fn output_word(&mut self, reset: bool, core: &dyn CycleModel) -> (bool, Vec<u16>) {
        let is_asked = core.is_high(PortRole::ReferenceReady);
        if reset {
            self.queue.clear();
            self.taken_words = 0;
        }
        let word = self.queue.oldest().map(<[u16]>::to_vec);
        let is_valid = word.is_some() && !(is_asked && self.taken_words == self.withheld_word);
        if is_asked && !reset {
            self.queue.pop();
            self.taken_words += 1;
        }
        (is_valid, word.unwrap_or_else(|| self.idle_word.clone()))
    }

    /// Stores the word that the core outputs after an edge.
    pub(super) fn store_output(&mut self, core: &dyn CycleModel) {
        self.queue.store_output(core);
    }
}
