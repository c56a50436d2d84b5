// SPDX-License-Identifier: MIT OR Apache-2.0
//! Who takes the pixels that leave: when a sink is ready.

use super::super::random::Random;

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

    /// Whether it is ready at the next edge.
    pub(super) fn next(&mut self, random: &mut Random) -> bool {
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
        }
    }
}
