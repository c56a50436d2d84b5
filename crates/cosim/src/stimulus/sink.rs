// SPDX-License-Identifier: MIT OR Apache-2.0
//! Who takes the pixels that leave: when a sink is ready.

use super::random::Random;
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;

/// A sink stalls where no region ends at one of so many clocks.
const UNLUCKY: u64 = 24;

/// The sink that loses most of those that stall.
const MOST_LOSSES: usize = 3;

/// How a sink behaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mood {
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
    /// Clocks of a row of words.
    row: u64,
    /// Clocks of the rows after which regions are lost, and two rows of regions more.
    long: u64,
    /// Which mood comes first.
    first: usize,
}

impl Sink {
    /// None where nobody may stall. A recording that has few sequences begins with a sink that loses regions.
    pub(super) fn of(design: &Design, is_brief: bool) -> Option<Self> {
        let timing = match design.hardware() {
            Hardware::Raster(own) => RasterTiming::of(design.on(own)),
            Hardware::Pipelined(_) | Hardware::Serial(_) => return None,
        };
        let row = timing.words() / u64::from(design.rows());
        let long = (u64::from(timing.buffer_rows) + 2) * row;
        let first = if is_brief { MOST_LOSSES } else { 0 };
        let mood = Mood::Willing;
        timing.forwards.then_some(Self { mood, is_ready: false, left: 0, row, long, first })
    }

    /// Begins anew. One that stalls does so for up to two rows of regions more than the buffer holds.
    pub(super) fn begin(&mut self, stalls: bool, turn: usize) {
        let mood = match (stalls, (turn + self.first) % 4) {
            (true, 0) => Mood::Slow,
            (true, 1 | 2) => Mood::Unlucky(self.long),
            (true, _) => Mood::Turns(self.long),
            (false, 0) => Mood::Willing,
            (false, 1) => Mood::Hesitant,
            (false, 2) => Mood::Turns(self.row / 2),
            (false, _) => Mood::Turns(9),
        };
        *self = Self { mood, is_ready: false, left: 0, ..*self };
    }

    /// From here on it is ready at every clock.
    pub(super) fn calm(&mut self) {
        self.mood = Mood::Willing;
    }

    /// Whether it is ready at the next edge, in front of this core.
    pub(super) fn next(&mut self, core: &dyn CycleModel, random: &mut Random) -> bool {
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
                let ends = ends_region(core);
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

/// Whether the last word of a region leaves that was not lost in the middle.
pub(crate) fn ends_region(core: &dyn CycleModel) -> bool {
    core.is_high(PortRole::ForwardValid)
        && core.is_high(PortRole::ForwardLast)
        && !core.is_high(PortRole::ForwardAbort)
}
