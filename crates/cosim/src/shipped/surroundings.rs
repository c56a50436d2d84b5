// SPDX-License-Identifier: MIT OR Apache-2.0
//! What surrounds a core in a bench: a sink that stalls, and a frame store outside that gives back what was stored.

use super::script::FRAMES;
use crate::stimulus::{Queue, ends_region};
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;

/// Regions lost in the middle after which the sink takes nothing any more, so that counters get far and the vectors of a
/// large frame stay small.
const ENOUGH_LOSSES: u64 = 64;

/// A sink that stalls: from the last word of a region on, when the first word of the next has been fetched, until a region
/// is lost. Every other time it takes a word at the edge of the loss.
pub(super) struct Stalling {
    is_ready: bool,
    /// The last word of a region that is on the ports made it stall before.
    has_stalled: bool,
    losses: u64,
}

impl Default for Stalling {
    fn default() -> Self {
        Self { is_ready: true, has_stalled: false, losses: 0 }
    }
}

impl Stalling {
    /// Whether it takes what leaves at the next edge.
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

/// A frame store outside: a queue whose words fall through.
pub(super) struct Outside {
    queue: Queue,
    /// A word that nobody may look at.
    nothing: Vec<u16>,
    /// Words that were taken since reset.
    taken: u64,
    /// The number of the word that is not said to be valid, though it is: the last of the frames that every script
    /// has. So the bench sees an underrun, and the decisions of its frames are those of references that are right.
    withheld: u64,
}

impl Outside {
    /// None where the core keeps its references.
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

    /// What is at the ports of references at the next edge, which may be a reset.
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

    /// Keeps what the core shows after an edge.
    pub(super) fn keep(&mut self, core: &dyn CycleModel) {
        self.queue.keep(core);
    }
}
