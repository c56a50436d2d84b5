// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sink that takes the pixels that leave a core, and the clocks at which it is ready.

use super::random::Random;
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;

/// One in so many clocks at which no region ends is the start of a stall.
const STALL_PERIOD: u64 = 24;

/// The offset of the turn with which the first stalling sink is the one that loses most regions.
const LOSSY_TURN_OFFSET: usize = 3;

/// The pattern of clocks at which a sink is ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ReadyPattern {
    /// The sink is ready at every clock.
    Always,
    /// The sink is ready at about every second clock.
    HalfOfClocks,
    /// The sink is ready at few clocks.
    FewClocks,
    /// The sink is ready and not ready in turn, for up to the given number of clocks each.
    Alternating(u64),
    /// The sink is ready until a region ends, when a word of the next region may have been fetched,
    /// or until a random word within a region. Then it stalls for up to the given number of clocks.
    /// At an edge at which a region is lost in the middle it may be ready, and may stall on.
    StallingInRegions(u64),
}

/// The state of a sink.
#[derive(Clone, Copy, Debug)]
pub(super) struct StimulusSink {
    pattern: ReadyPattern,
    is_ready: bool,
    /// The number of clocks until the sink changes between ready and not ready.
    clocks_left: u64,
    /// The number of clocks of a row of regions.
    row_clocks: u64,
    /// The number of clocks of the rows after which regions are lost, and of two more rows of
    /// regions.
    longest_stall: u64,
    /// The number that is added to the turn, which decides the behavior of the first sequence.
    turn_offset: usize,
}

impl StimulusSink {
    /// Returns a sink, or `None` if no sink may stall. A recording with few sequences begins with a
    /// sink that loses regions.
    pub(super) fn for_design(design: &Design, is_brief: bool) -> Option<Self> {
        let timing = match design.hardware() {
            Hardware::Raster(own) => RasterTiming::from_design(design.with_hardware(own)),
            Hardware::Pipelined(_) | Hardware::Serial(_) => return None,
        };
        let row = timing.words() / u64::from(design.rows());
        let long = (u64::from(timing.buffer_rows) + 2) * row;
        let first = if is_brief { LOSSY_TURN_OFFSET } else { 0 };
        let pattern = ReadyPattern::Always;
        timing.has_forwarding.then_some(Self {
            pattern,
            is_ready: false,
            clocks_left: 0,
            row_clocks: row,
            longest_stall: long,
            turn_offset: first,
        })
    }

    /// Begins a sequence. A sink that stalls does so for up to two rows of regions more than the
    /// buffer holds.
    pub(super) fn begin(&mut self, stalls: bool, turn: usize) {
        let pattern = match (stalls, (turn + self.turn_offset) % 4) {
            (true, 0) => ReadyPattern::FewClocks,
            (true, 1 | 2) => ReadyPattern::StallingInRegions(self.longest_stall),
            (true, _) => ReadyPattern::Alternating(self.longest_stall),
            (false, 0) => ReadyPattern::Always,
            (false, 1) => ReadyPattern::HalfOfClocks,
            (false, 2) => ReadyPattern::Alternating(self.row_clocks / 2),
            (false, _) => ReadyPattern::Alternating(9),
        };
        *self = Self { pattern, is_ready: false, clocks_left: 0, ..*self };
    }

    /// Makes the sink ready at every clock from now on.
    pub(super) fn make_ready(&mut self) {
        self.pattern = ReadyPattern::Always;
    }

    /// Returns true if the sink of this core is ready at the next edge.
    pub(super) fn is_ready_next(&mut self, core: &dyn CycleModel, random: &mut Random) -> bool {
        match self.pattern {
            ReadyPattern::Always => true,
            ReadyPattern::HalfOfClocks => random.one_in(2),
            ReadyPattern::FewClocks => random.one_in(9),
            ReadyPattern::Alternating(longest) => {
                if self.clocks_left == 0 {
                    self.is_ready = !self.is_ready;
                    self.clocks_left = 1 + random.up_to(longest);
                }
                self.clocks_left -= 1;
                self.is_ready
            }
            ReadyPattern::StallingInRegions(longest) => {
                let ends = is_region_end_leaving(core);
                if self.clocks_left == 0 && random.one_in(if ends { 2 } else { STALL_PERIOD }) {
                    self.clocks_left = 1 + random.up_to(longest);
                }
                if self.clocks_left > 0 && core.will_abort() {
                    self.clocks_left *= random.up_to(1);
                    return random.one_in(2);
                }
                let stalls = self.clocks_left > 0;
                self.clocks_left = self.clocks_left.saturating_sub(1);
                !stalls
            }
        }
    }
}

/// Returns true if the last word of a region leaves, and the region was not lost in the middle.
pub(crate) fn is_region_end_leaving(core: &dyn CycleModel) -> bool {
    core.is_high(PortRole::ForwardValid)
        && core.is_high(PortRole::ForwardLast)
        && !core.is_high(PortRole::ForwardAbort)
}
