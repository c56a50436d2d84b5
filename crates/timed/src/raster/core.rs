// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks of a raster core: advances, decisions, and the edges at which it is ready.

use std::sync::Arc;

use foveate_design::RasterTiming;
use foveate_engine::Engine;
use foveate_pixels::FramePixels;

use super::readout::{Readout, ReadoutContext, SendingRegion};
use super::staleness::RowStaleness;
use crate::clocks::FrameClocks;
use crate::timed_core::{CoreContext, CoreFrame, TimedCore};
use crate::{BeatOffer, DecisionRun, RegionRun, SentKind, SentValues, Transaction};

/// A raster core between two frames.
#[derive(Debug)]
pub(crate) struct RasterCore {
    timing: RasterTiming,
    /// The first edge at which the core can take the first word of a frame.
    open_from: u64,
    /// The number of frames since reset.
    frames: u64,
    /// The first edge at which a second pass may begin, after the pass before.
    next_pass: u64,
    /// The clocks of the decisions of the last frame, region by region.
    decisions: Vec<u64>,
    decided_frame: u64,
    /// The number of decisions of the last frame that were yielded.
    decided: usize,
    staleness: RowStaleness,
    readout: Readout,
    /// The regions that were lost, and that the engine does not know of yet.
    losses: Vec<u32>,
}

impl RasterCore {
    pub(crate) fn new(timing: RasterTiming) -> Self {
        Self {
            timing,
            open_from: 0,
            frames: 0,
            next_pass: 0,
            decisions: Vec::new(),
            decided_frame: 0,
            decided: 0,
            staleness: RowStaleness::new(timing.buffer_rows.into()),
            readout: Readout::new(&timing),
            losses: Vec::new(),
        }
    }

    /// Returns the number of the advance that takes word number `beat` of a frame.
    fn advance_of_beat(&self, beat: u64) -> u64 {
        let taken = u64::from(self.timing.taken_words);
        beat / taken * u64::from(self.timing.row_words) + beat % taken
    }

    /// Returns the edges of the advances of a frame: each advance happens one edge after the
    /// advance before it, unless it takes a word for which it has to wait.
    fn clocks(&self, offers: &[BeatOffer]) -> FrameClocks {
        let offers = offers.iter().map(|offer| (self.advance_of_beat(offer.beat), offer.clock));
        FrameClocks::new(self.open_from, offers)
    }

    /// Records the edges at which the first words of the rows of regions are stored.
    fn store_rows(&mut self, clocks: &FrameClocks) {
        let (words, to_tail) = (self.timing.words_per_region_row(), self.timing.tail_delay());
        for row in 0..self.region_rows() {
            let advance = row * words + to_tail;
            self.staleness.push_row(clocks.edge(advance) + u64::from(self.timing.store_latency));
        }
    }

    /// Decides the engine's last frame row of regions by row of regions, and yields the
    /// transactions before edge `end`.
    fn decide_frame(
        &mut self,
        clocks: &FrameClocks,
        pixels: FramePixels<'_>,
        end: u64,
        context: &mut CoreContext<'_>,
    ) {
        self.decisions.clear();
        (self.decided_frame, self.decided) = (self.frames, 0);
        for row in 0..self.region_rows() {
            self.decide_row(row, clocks, context.engine);
            self.run_until(end, Some(pixels), context);
        }
    }

    /// Computes the clocks of the decisions of a row of regions, and puts the regions that send
    /// into the queue.
    fn decide_row(&mut self, row: u64, clocks: &FrameClocks, engine: &Engine) {
        let timing = self.timing;
        let width = u64::from(timing.region_row_words);
        let row_words = u64::from(timing.row_words);
        // The advance that brings the first word of the last row of pixels to the tail.
        let last_row = (row + 1) * timing.words_per_region_row() - row_words + timing.tail_delay();
        for column in 1..=row_words / width {
            let decision = self.decision_clock(clocks.edge(last_row + column * width - 1));
            let region = self.decisions.len();
            self.decisions.push(decision);
            let action = engine.outcome().actions[region];
            if let (Some(kind), Some(words)) =
                (SentKind::from_action(action), timing.words_sent(action))
            {
                self.readout.push(SendingRegion {
                    region: u32::try_from(region).expect("a region has 32 bits"),
                    frame: self.frames,
                    row: self.frames * self.region_rows() + row,
                    kind,
                    words,
                    entered: decision + 1,
                    copy: None,
                });
            }
        }
    }

    /// Returns the rows of regions of a frame, R.
    fn region_rows(&self) -> u64 {
        self.timing.words() / self.timing.words_per_region_row()
    }

    /// Returns the clock of the decision of a region whose last word comes to the tail at edge
    /// `last_word`.
    fn decision_clock(&mut self, last_word: u64) -> u64 {
        let timing = &self.timing;
        match timing.second_pass {
            None => last_word + u64::from(timing.decision_latency),
            Some(pass) => {
                let stored = last_word + u64::from(timing.store_latency);
                let first = self.next_pass.max(stored + u64::from(pass.after_store));
                self.next_pass = first + u64::from(timing.region_words);
                self.next_pass - 1 + u64::from(pass.decision_latency)
            }
        }
    }

    /// Yields the transactions before edge `end`, and tells the engine what was lost. `raw` are the
    /// raw pixels of the engine's last frame, unless nothing of that frame waits without a copy.
    fn run_until(&mut self, end: u64, raw: Option<FramePixels<'_>>, context: &mut CoreContext<'_>) {
        self.yield_decisions(end, context);
        let engine = &*context.engine;
        let word = self.timing.word_pixels;
        self.readout.run(
            end,
            &mut ReadoutContext {
                staleness: &self.staleness,
                sink: context.sink,
                visit: context.visit,
                values: raw.map(|raw| SentValues::of_last_frame(engine, raw, word)),
                word_pixels: word,
                losses: &mut self.losses,
            },
        );
        for region in self.losses.drain(..) {
            context.engine.forget_region(region);
        }
    }

    fn yield_decisions(&mut self, end: u64, context: &mut CoreContext<'_>) {
        let first = self.decided;
        let clocks = self.decisions[first..].iter().take_while(|&&clock| clock < end);
        for (&clock, region) in clocks.zip(u32::try_from(first).expect("a region has 32 bits")..) {
            self.decided += 1;
            (context.visit)(&Transaction::Decisions(DecisionRun {
                frame: self.decided_frame,
                regions: RegionRun::single(clock, region),
                outcome: context.engine.outcome(),
            }));
        }
    }

    /// Copies what waiting regions send, before the engine takes the next frame.
    fn copy_waiting(&mut self, raw: FramePixels<'_>, engine: &Engine) {
        let values = SentValues::of_last_frame(engine, raw, self.timing.word_pixels);
        let mut oldest = None;
        for sender in self.readout.waiting() {
            oldest = oldest.or(Some(sender.row));
            if sender.copy.is_none() {
                let mut copy = Vec::new();
                values.append_region(sender.region, &mut copy);
                sender.copy = Some(Arc::from(copy));
            }
        }
        let next = (self.frames + 1) * self.region_rows();
        self.staleness.drop_before(oldest.unwrap_or(next));
    }
}

impl TimedCore for RasterCore {
    fn open_from(&self) -> u64 {
        self.open_from
    }

    fn has_ready_output(&self) -> bool {
        true
    }

    fn take_edge(&self, offers: &[BeatOffer], beat: u64) -> u64 {
        self.clocks(offers).edge(self.advance_of_beat(beat))
    }

    fn take_frame(&mut self, frame: CoreFrame<'_>, end: u64, context: &mut CoreContext<'_>) {
        let clocks = self.clocks(frame.offers);
        let last_beat = self.timing.taken_words_per_frame() - 1;
        let last_taken = clocks.edge(self.advance_of_beat(last_beat));
        let ready = last_taken + self.timing.edges_to_ready();
        self.store_rows(&clocks);
        // All that is left of the frame before happens before its regions are stored again.
        let certain = end.min(ready + 1);
        self.run_until(certain, None, context);
        context.engine.step_pixels(frame.pixels).expect("the model has checked the frame");
        if self.timing.waits_for_pending {
            self.decide_frame(&clocks, frame.pixels, end, context);
            let last_decision = self.decisions.last().copied().unwrap_or_default();
            let taken = self.readout.last_taken(context.sink);
            self.open_from = ready.max(last_decision).max(taken) + 1;
        } else {
            self.decide_frame(&clocks, frame.pixels, certain, context);
            self.open_from = ready + 1;
        }
        self.copy_waiting(frame.pixels, context.engine);
        self.frames += 1;
    }

    fn finish(&mut self, end: u64, context: &mut CoreContext<'_>) {
        self.run_until(end, None, context);
    }

    fn reset(&mut self, edge: u64) {
        self.open_from = edge + 1;
        (self.frames, self.next_pass, self.decided) = (0, 0, 0);
        self.decisions.clear();
        self.staleness.reset();
        self.readout.reset();
    }
}
