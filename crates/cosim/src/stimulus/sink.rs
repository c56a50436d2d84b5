// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sink that takes the pixels that leave a core, and the clocks at which it is ready.

use super::random::Random;
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;

/// One in so many clocks at which no region ends is the start of a stall.
const UNLUCKY: u64 = 24;

/// The offset of the turn with which the first stalling sink is the one that loses most regions.
const MOST_LOSSES: usize = 3;

/// The pattern of clocks at which a sink is ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mood {
    /// The sink is ready at every clock.
    Willing,
    /// The sink is ready at about every second clock.
    Hesitant,
    /// The sink is ready at few clocks.
    Slow,
    /// The sink is ready and not ready in turn, for up to the given number of clocks each.
    Turns(u64),
    /// The sink is ready until a region ends, when a word of the next region may have been fetched,
    /// or until a random word within a region. Then it stalls for up to the given number of clocks.
    /// At an edge at which a region is lost in the middle it may be ready, and may stall on.
    Unlucky(u64),
}

/// The state of a sink.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sink {
    mood: Mood,
    is_ready: bool,
    /// The number of clocks until the sink changes between ready and not ready.
    left: u64,
    /// The number of clocks of a row of regions.
    row: u64,
    /// The number of clocks of the rows after which regions are lost, and of two more rows of
    /// regions.
    long: u64,
    /// The number that is added to the turn, which decides the behavior of the first sequence.
    first: usize,
}

impl Sink {
    /// Returns a sink, or `None` if no sink may stall. A recording with few sequences begins with a
    /// sink that loses regions.
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

    /// Begins a sequence. A sink that stalls does so for up to two rows of regions more than the
    /// buffer holds.
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

    /// Makes the sink ready at every clock from now on.
    pub(super) fn calm(&mut self) {
        self.mood = Mood::Willing;
    }

    /// Returns true if the sink of this core is ready at the next edge.
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

/// Returns true if the last word of a region leaves, and the region was not lost in the middle.
pub(crate) fn ends_region(core: &dyn CycleModel) -> bool {
    core.is_high(PortRole::ForwardValid)
        && core.is_high(PortRole::ForwardLast)
        && !core.is_high(PortRole::ForwardAbort)
}
