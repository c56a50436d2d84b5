// SPDX-License-Identifier: MIT OR Apache-2.0
//! Who takes the pixels that leave: when a sink is ready.

use super::super::random::Random;
use foveate_model::RasterRcm;

/// A sink stalls where no region ends at one of so many clocks.
const UNLUCKY: u64 = 24;

/// How a sink behaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mood {
    /// Ready at every clock.
    Willing,
    /// Ready at about every other clock.
    Hesitant,
    /// Ready at few clocks.
    Slow,
    /// Ready and not in turns of up to so many clocks.
    Turns(u64),
    /// Ready until a region ends, when a word of the next may have been fetched, or until anywhere in it; then not for up to
    /// so many clocks. At an edge at which a region is lost in the middle it may be ready, and go on or not.
    Unlucky(u64),
}

/// A sink under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sink {
    mood: Mood,
    is_ready: bool,
    /// Clocks that its turn goes on.
    left: u64,
}

impl Sink {
    pub(super) fn new(mood: Mood) -> Self {
        Self { mood, is_ready: false, left: 0 }
    }

    /// Whether it is ready at the next edge, in front of this core.
    pub(super) fn next(&mut self, core: &RasterRcm, random: &mut Random) -> bool {
        match self.mood {
            Mood::Willing => true,
            Mood::Hesitant => random.one_in(2),
            Mood::Slow => random.one_in(9),
            Mood::Turns(longest) => {
                if self.left == 0 {
                    self.is_ready = !self.is_ready;
                    self.left = 1 + random.up_to(longest);
                }
                self.left -= 1;
                self.is_ready
            }
            Mood::Unlucky(longest) => {
                let shown = core.output();
                let ends = shown.forward_valid && shown.forward_last && !shown.forward_abort;
                if self.left == 0 && random.one_in(if ends { 2 } else { UNLUCKY }) {
                    self.left = 1 + random.up_to(longest);
                }
                if self.left > 0 && core.aborts_next() {
                    self.left *= random.up_to(1);
                    return random.one_in(2);
                }
                let stalls = self.left > 0;
                self.left = self.left.saturating_sub(1);
                !stalls
            }
        }
    }
}
