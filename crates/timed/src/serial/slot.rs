// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outputs of the lanes for one slot, phase by phase.

use std::ops::Range;

use foveate_camera::Periphery;
use foveate_design::{PixelFeed, SerialDesign, SerialPhase, SerialTiming};
use foveate_engine::FrameOutcome;

use crate::{DecisionRun, RegionRun, ScoreRun, SentKind, SentValues, Transaction, WordRun};

/// The phases of a slot.
#[derive(Debug)]
pub(super) struct SlotSchedule {
    timing: SerialTiming,
    feed: PixelFeed,
    /// The regions per lane, K.
    fold: u32,
    /// The regions of the frame, M.
    regions: u32,
    /// The number of the last score, with which regions are decided.
    last_score: u32,
    /// The pixels of a region, n.
    pixels: u32,
    /// The means of a summary.
    means: u32,
}

/// The output of the steps of one frame.
pub(super) struct FrameOutput<'a> {
    pub(super) schedule: &'a SlotSchedule,
    /// The number of the frame since reset.
    pub(super) frame: u64,
    /// The edge T0.
    pub(super) start: u64,
    /// The clocks whose transactions are yielded.
    pub(super) within: Range<u64>,
    pub(super) outcome: &'a FrameOutcome,
    pub(super) values: SentValues<'a>,
    pub(super) visit: &'a mut dyn FnMut(&Transaction<'_>),
}

impl SlotSchedule {
    pub(super) fn new(design: SerialDesign<'_>, timing: SerialTiming) -> Self {
        Self {
            timing,
            feed: design.feed(),
            fold: design.fold(),
            regions: design.regions(),
            last_score: design.score_count() - 1,
            pixels: design.region_pixels(),
            means: design.periphery().map_or(0, Periphery::mean_count),
        }
    }

    pub(super) fn timing(&self) -> &SerialTiming {
        &self.timing
    }

    /// Returns the regions of the lanes in a slot. The slots of the last lane may be empty.
    fn regions_of_slot(&self, slot: u32, clock: u64, clock_step: u64) -> RegionRun {
        let regions = (self.regions - slot).div_ceil(self.fold);
        RegionRun { clock, region: slot, regions, region_step: self.fold, clock_step }
    }
}

impl FrameOutput<'_> {
    /// Yields the transactions, slot by slot and phase by phase.
    pub(super) fn run(mut self) {
        let timing = &self.schedule.timing;
        let mut step = 0;
        for slot in 0..timing.slots() {
            let mut score = 0;
            for &(phase, steps) in timing.phases() {
                let clock = self.start + timing.edges_to_step(step);
                match phase {
                    SerialPhase::PassClasses
                    | SerialPhase::DenoiseAndCompare
                    | SerialPhase::RepeatBorder
                    | SerialPhase::CompareRaw
                    | SerialPhase::ComputeMeans
                    | SerialPhase::FeaturePass(_)
                    | SerialPhase::CopyReference => {}
                    SerialPhase::RotateCount | SerialPhase::RotateScore(_) => {
                        self.rotate(slot, score, clock);
                        score += 1;
                    }
                    SerialPhase::UnloadPixels => {
                        self.unload(slot, (SentKind::Pixels, self.schedule.pixels), clock, steps);
                    }
                    SerialPhase::UnloadMeans => {
                        self.unload(slot, (SentKind::Means, self.schedule.means), clock, steps);
                    }
                }
                step += steps;
            }
        }
    }

    /// Yields a rotation: a score of the lanes passes the ports, lane by lane.
    fn rotate(&mut self, slot: u32, number: u32, clock: u64) {
        let first = clock + u64::from(self.schedule.timing.settling_steps());
        let regions = self.schedule.regions_of_slot(slot, first, 1);
        let Some(regions) = regions.within(&self.within) else { return };
        let (frame, outcome) = (self.frame, self.outcome);
        (self.visit)(&Transaction::Scores(ScoreRun { frame, number, regions, outcome }));
        if number == self.schedule.last_score {
            (self.visit)(&Transaction::Decisions(DecisionRun { frame, regions, outcome }));
        }
    }

    /// Yields a phase in which `words` words of each region leave.
    fn unload(&mut self, slot: u32, (kind, words): (SentKind, u32), clock: u64, steps: u64) {
        let word_step = steps / u64::from(words);
        let regions = match self.schedule.feed {
            // The words of all lanes leave together, in the last step of a round.
            PixelFeed::Parallel => self.schedule.regions_of_slot(slot, clock + word_step - 1, 0),
            // The words leave lane by lane, behind the first step of a round.
            PixelFeed::Raster => self.schedule.regions_of_slot(slot, clock + 1, 1),
        };
        let run = WordRun {
            frame: self.frame,
            kind,
            regions,
            first: 0,
            words,
            word_step,
            is_last: true,
            is_aborted: false,
            actions: Some(&self.outcome.actions),
            values: self.values,
        };
        if self.within.start <= clock && clock + steps <= self.within.end {
            (self.visit)(&Transaction::Words(run));
            return;
        }
        // Only some of the words are yielded.
        for word in 0..words {
            let regions =
                RegionRun { clock: regions.clock + u64::from(word) * word_step, ..regions };
            if let Some(regions) = regions.within(&self.within) {
                let is_last = word + 1 == words;
                let single = WordRun { regions, first: word, words: 1, is_last, ..run };
                (self.visit)(&Transaction::Words(single));
            }
        }
    }
}
