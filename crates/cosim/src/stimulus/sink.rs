// SPDX-License-Identifier: MIT OR Apache-2.0
//! The surroundings of a core at its outputs: the sink that takes its pixels, and is ready at
//! some clocks only ([`Sink`]), and an external frame store, which returns in the next frame
//! the words that the core stores ([`ExternalStore`]). The store may lack the word that the
//! core asks for, or return a wrong one.

use super::random::Random;
use super::unused_inputs::UnusedInputs;
use foveate_design::{Design, Hardware, PortRole, RasterTiming};
use foveate_model::CycleModel;
use std::collections::VecDeque;

/// One in so many clocks at which no region ends is the start of a stall.
const STALL_PERIOD: u64 = 24;
/// The number of losses after which a sink that stalls until regions are lost takes nothing any
/// more. Counters of lost regions then count on, and vectors of large frames stay small.
const ENOUGH_LOSSES: u64 = 64;
/// The number of clocks that a word waits for a sink that delays words.
const DELAY: u64 = 2;

/// The pattern of clocks at which a sink is ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SinkPattern {
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
    /// The sink stalls from the last word of a region on, once the first word of the next region
    /// has been fetched, until a region is lost. At every second loss it takes a word at the edge
    /// of the loss.
    StallingUntilLoss,
    /// The sink lets every word wait for some clocks.
    Delaying,
}

/// A sink, and the state of its pattern.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sink {
    pattern: SinkPattern,
    is_ready: bool,
    /// The number of clocks until the sink changes between ready and not ready, or for which the
    /// word at the ports has waited.
    clocks: u64,
    /// True if the sink has already stalled for the last word that is at the ports.
    has_stalled: bool,
    losses: u64,
    /// The number of clocks of a row of regions.
    row_clocks: u64,
    /// The number of clocks of the rows after which regions are lost, and of two more rows of
    /// regions.
    longest_stall: u64,
}

impl Sink {
    /// Returns a sink that is always ready, or `None` if no sink may stall.
    pub(super) fn for_design(design: &Design) -> Option<Self> {
        let timing = match design.hardware() {
            Hardware::Raster(own) => RasterTiming::from_design(design.with_hardware(own)),
            Hardware::Pipelined(_) | Hardware::Serial(_) => return None,
        };
        let row = timing.words() / u64::from(design.rows());
        timing.has_forwarding.then_some(Self {
            pattern: SinkPattern::Always,
            is_ready: false,
            clocks: 0,
            has_stalled: false,
            losses: 0,
            row_clocks: row,
            longest_stall: (u64::from(timing.buffer_rows) + 2) * row,
        })
    }

    /// Returns the pattern for a sequence. A sink that stalls does so for up to two rows of regions
    /// more than the buffer holds.
    pub(super) fn pattern_of_turn(&self, stalls: bool, turn: usize) -> SinkPattern {
        match (stalls, turn % 4) {
            (true, 0) => SinkPattern::FewClocks,
            (true, 1 | 2) => SinkPattern::StallingInRegions(self.longest_stall),
            (true, _) => SinkPattern::Alternating(self.longest_stall),
            (false, 0) => SinkPattern::Always,
            (false, 1) => SinkPattern::HalfOfClocks,
            (false, 2) => SinkPattern::Alternating(self.row_clocks / 2),
            (false, _) => SinkPattern::Alternating(9),
        }
    }

    /// Sets the pattern from now on; a pattern that stays goes on where it was.
    pub(super) fn set_pattern(&mut self, pattern: SinkPattern) {
        if self.pattern != pattern {
            let is_ready = pattern == SinkPattern::StallingUntilLoss;
            *self = Self { pattern, is_ready, clocks: 0, has_stalled: false, losses: 0, ..*self };
        }
    }

    /// Returns true if the sink of this core is ready at the next edge.
    pub(super) fn is_ready_next(&mut self, core: &dyn CycleModel, random: &mut Random) -> bool {
        match self.pattern {
            SinkPattern::Always => true,
            SinkPattern::HalfOfClocks => random.one_in(2),
            SinkPattern::FewClocks => random.one_in(9),
            SinkPattern::Alternating(longest) => {
                if self.clocks == 0 {
                    self.is_ready = !self.is_ready;
                    self.clocks = 1 + random.up_to(longest);
                }
                self.clocks -= 1;
                self.is_ready
            }
            SinkPattern::StallingInRegions(longest) => {
                let ends = is_region_end_leaving(core);
                if self.clocks == 0 && random.one_in(if ends { 2 } else { STALL_PERIOD }) {
                    self.clocks = 1 + random.up_to(longest);
                }
                if self.clocks > 0 && core.will_abort() {
                    self.clocks *= random.up_to(1);
                    return random.one_in(2);
                }
                let stalls = self.clocks > 0;
                self.clocks = self.clocks.saturating_sub(1);
                !stalls
            }
            SinkPattern::StallingUntilLoss => self.stalls_until_loss(core),
            SinkPattern::Delaying => {
                let waits = core.is_high(PortRole::ForwardValid);
                let takes = waits && self.clocks == DELAY;
                self.clocks = if waits && !takes { self.clocks + 1 } else { 0 };
                takes
            }
        }
    }

    /// Returns true if a sink that stalls until a region is lost is ready at the next edge.
    fn stalls_until_loss(&mut self, core: &dyn CycleModel) -> bool {
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
        // Only whole regions are lost while no word of the next region has been fetched. The sink
        // then goes on, and stalls for another region.
        if self.losses == 0 && core.is_high(PortRole::LostValid) {
            (self.is_ready, self.has_stalled) = (true, ends);
        }
        if self.is_ready && ends {
            self.is_ready = std::mem::take(&mut self.has_stalled);
        }
        self.is_ready
    }
}

/// Returns true if the last word of a region leaves, and the region was not lost in the middle.
fn is_region_end_leaving(core: &dyn CycleModel) -> bool {
    core.is_high(PortRole::ForwardValid)
        && core.is_high(PortRole::ForwardLast)
        && !core.is_high(PortRole::ForwardAbort)
}

/// One in so many words is wrong.
const WRONG_WORD_PERIOD: u64 = 5;

/// A fault of the frame store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StoreFault {
    /// No fault.
    None,
    /// Some words are late by one request, so all words after one are off by one.
    Late,
    /// Some words are missing and never come.
    Missing,
    /// The word with this index, counted from the first one that the core asks for, comes without
    /// its valid bit.
    UnmarkedWord(u64),
    /// Some words are wrong.
    Wrong,
}

/// An external frame store with a fault.
pub(super) struct ExternalStore {
    /// The words that were stored and not yet returned, the oldest first.
    words: VecDeque<Vec<u16>>,
    fault: StoreFault,
    /// The indices of the words that are late, missing or unmarked, counted from the first word
    /// that the core asks for.
    missing: [u64; 2],
    /// The number of words that the core has asked for since reset.
    requested_words: u64,
    random: Random,
    unused: UnusedInputs,
    timing: RasterTiming,
    max: u16,
}

impl ExternalStore {
    /// Returns the store, or `None` if the core stores its own references.
    pub(super) fn for_design(
        design: &Design,
        unused: UnusedInputs,
        random: Random,
    ) -> Option<Self> {
        let design = match design.hardware() {
            Hardware::Raster(own) => design.with_hardware(own),
            Hardware::Pipelined(_) | Hardware::Serial(_) => return None,
        };
        design.has_external_store().then(|| Self {
            words: VecDeque::new(),
            fault: StoreFault::None,
            missing: [0; 2],
            requested_words: 0,
            random,
            unused,
            timing: RasterTiming::from_design(design),
            max: u16::try_from(design.pixel_max()).expect("a pixel has at most 16 bits"),
        })
    }

    /// Empties the store for a reset, and sets its fault from now on.
    pub(super) fn begin(&mut self, fault: StoreFault) {
        self.words.clear();
        self.fault = fault;
        self.requested_words = 0;
        let (row, words) = (u64::from(self.timing.row_words), self.timing.words());
        // One word is missing at the ends of rows and frames, and one anywhere in the second frame
        // with references.
        let places = [0, 1, row - 1, row, words - 1, words];
        let directed = places[self.random.index(places.len() - 1)];
        self.missing = match fault {
            StoreFault::UnmarkedWord(word) => [word; 2],
            StoreFault::None | StoreFault::Late | StoreFault::Missing | StoreFault::Wrong => {
                [directed, words + self.random.up_to(words - 1)]
            }
        };
    }

    /// Returns the valid bit and the word at the reference ports for the next edge; `before` is the
    /// core before that edge.
    pub(super) fn output_word(&mut self, before: &dyn CycleModel) -> (bool, Vec<u16>) {
        if !before.is_high(PortRole::ReferenceReady) {
            return self.unused_output();
        }
        let is_missing = self.missing.contains(&self.requested_words);
        self.requested_words += 1;
        let word = match self.fault {
            StoreFault::Late if is_missing => None,
            StoreFault::Missing if is_missing => {
                self.words.pop_front();
                None
            }
            StoreFault::UnmarkedWord(_) if is_missing => {
                let word = self.words.pop_front();
                return (false, word.unwrap_or_else(|| self.unused_word()));
            }
            StoreFault::None
            | StoreFault::Late
            | StoreFault::Missing
            | StoreFault::UnmarkedWord(_)
            | StoreFault::Wrong => self.words.pop_front(),
        };
        let is_wrong = self.fault == StoreFault::Wrong && self.random.one_in(WRONG_WORD_PERIOD);
        match word {
            Some(word) => (true, if is_wrong { self.unused_word() } else { word }),
            None => (false, self.unused_word()),
        }
    }

    /// Returns the valid bit and a word that the core must not use.
    fn unused_output(&mut self) -> (bool, Vec<u16>) {
        let oldest = self.words.front().cloned();
        let is_valid = match self.unused {
            UnusedInputs::Random => self.random.one_in(2),
            UnusedInputs::Constant { .. } => oldest.is_some(),
        };
        let word = oldest.filter(|_| self.unused.bit(&mut self.random));
        (is_valid, word.unwrap_or_else(|| self.unused_word()))
    }

    /// Stores the word that the core outputs after an edge, if there is one.
    pub(super) fn store_output(&mut self, after: &dyn CycleModel) {
        if after.is_high(PortRole::StoreValid) {
            let mut word = Vec::new();
            after.append_output(PortRole::StorePixel, &mut word);
            let pixel = |value| u16::try_from(value).expect("a pixel has at most 16 bits");
            self.words.push_back(word.into_iter().map(pixel).collect());
        }
    }

    fn unused_word(&mut self) -> Vec<u16> {
        self.unused.pixels(self.timing.word_pixels as usize, self.max, &mut self.random)
    }
}
