// SPDX-License-Identifier: MIT OR Apache-2.0
//! The surroundings of a core in a bench: a sink that stalls, and an external frame store that
//! returns what was stored.

use super::script::FRAMES;
use crate::stimulus::{Queue, ends_region};
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;

/// The number of losses after which the sink takes nothing any more. Lost counters then count on,
/// and the vectors of a large frame stay small.
const ENOUGH_LOSSES: u64 = 64;

/// A sink that stalls from the last word of a region on, once the first word of the next region has
/// been fetched, until a region is lost. At every second loss it takes a word at the edge of the
/// loss.
pub(super) struct Stalling {
    is_ready: bool,
    /// True if the sink has already stalled for the last word that is on the ports.
    has_stalled: bool,
    losses: u64,
}

impl Default for Stalling {
    fn default() -> Self {
        Self { is_ready: true, has_stalled: false, losses: 0 }
    }
}

impl Stalling {
    /// Returns true if the sink takes a word at the next edge.
    pub(super) fn next(&mut self, core: &dyn CycleModel) -> bool {
        if self.losses == ENOUGH_LOSSES {
            return false;
        }
        let ends = ends_region(core);
        if core.aborts_next() {
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
pub(super) struct Outside {
    queue: Queue,
    /// The word that is shown while no word is valid.
    nothing: Vec<u16>,
    /// The number of words taken since reset.
    taken: u64,
    /// The index of the word that is stored but not marked as valid: the last word of the frames
    /// that every script has. So the bench sees an underrun, and all decisions of its frames use
    /// correct references.
    withheld: u64,
}

impl Outside {
    /// Returns the store, or `None` if the core stores its own references.
    pub(super) fn of(part: &Design) -> Option<Self> {
        let part = match part.hardware() {
            Hardware::Raster(own) => part.on(own),
            Hardware::Pipelined(_) | Hardware::Serial(_) => return None,
        };
        part.frames_are_kept_outside().then(|| Self {
            queue: Queue::default(),
            nothing: vec![0; part.pixels_per_clock() as usize],
            taken: 0,
            withheld: (FRAMES - 1) * RasterTiming::of(part).words() - 1,
        })
    }

    /// Returns the valid bit and the word at the reference ports for the next edge, which may be a
    /// reset.
    pub(super) fn show(&mut self, reset: bool, core: &dyn CycleModel) -> (bool, Vec<u16>) {
        let is_asked = core.is_high(PortRole::ReferenceReady);
        if reset {
            self.queue.forget();
            self.taken = 0;
        }
        let word = self.queue.oldest().map(<[u16]>::to_vec);
        let is_valid = word.is_some() && !(is_asked && self.taken == self.withheld);
        if is_asked && !reset {
            self.queue.pop();
            self.taken += 1;
        }
        (is_valid, word.unwrap_or_else(|| self.nothing.clone()))
    }

    /// Stores the word that the core outputs after an edge.
    pub(super) fn keep(&mut self, core: &dyn CycleModel) {
        self.queue.keep(core);
    }
}
