// SPDX-License-Identifier: MIT OR Apache-2.0
//! A serial array between two frames ([`SerialCore`]): it takes a frame and works on it slot by
//! slot. Taking needs one clock for each pixel, or for each place in the lanes where a pixel of
//! a raster feed is stored ([`IntakeClocks`]). The outputs of the lanes come for one slot,
//! phase by phase ([`FrameOutput`]).

use crate::clocks::FrameClocks;
use crate::timed_core::{CoreContext, CoreFrame, TimedCore};
use crate::transaction::KeptPixels;
use crate::{
    BeatOffer, DecisionRun, RegionRun, ScoreRun, SentKind, SentValues, Transaction, WordRun,
};
use foveate_camera::Periphery;
use foveate_design::{PixelFeed, SerialDesign, SerialPhase, SerialTiming};
use foveate_engine::FrameOutcome;
use foveate_pixels::FramePixels;
use std::ops::Range;

#[derive(Debug)]
pub(crate) struct SerialCore {
    intake: IntakeClocks,
    schedule: SlotSchedule,
    /// The first edge at which the array can take a pixel of the next frame.
    open_from: u64,
    /// The number of frames since reset.
    frames: u64,
    /// The edge T0 of the last frame.
    start: u64,
    /// The pixels of the last frame, if its last step may come when the array is ready again.
    unfinished: Option<KeptPixels>,
}

impl SerialCore {
    pub(crate) fn new(design: SerialDesign<'_>, timing: SerialTiming) -> Self {
        Self {
            intake: IntakeClocks::new(design, timing.load_pixels()),
            schedule: SlotSchedule::new(design, timing),
            open_from: 0,
            frames: 0,
            start: 0,
            unfinished: None,
        }
    }

    fn clocks(&self, offers: &[BeatOffer]) -> FrameClocks {
        let places = offers.iter().map(|offer| (self.intake.place(offer.beat), offer.clock));
        FrameClocks::new(self.open_from, places)
    }

    /// Yields the transactions of the last frame, which has these pixels, within some clocks.
    fn yield_frame(
        &self,
        pixels: FramePixels<'_>,
        within: Range<u64>,
        context: &mut CoreContext<'_>,
    ) {
        let output = FrameOutput {
            schedule: &self.schedule,
            frame: self.frames - 1,
            start: self.start,
            within,
            outcome: context.engine.outcome(),
            values: SentValues::of_last_frame(context.engine, pixels, 1),
            visit: context.visit,
        };
        output.run();
    }
}

impl TimedCore for SerialCore {
    fn open_from(&self) -> u64 {
        self.open_from
    }

    fn has_ready_output(&self) -> bool {
        true
    }

    fn take_edge(&self, offers: &[BeatOffer], beat: u64) -> u64 {
        self.clocks(offers).edge(self.intake.place(beat))
    }

    fn take_frame(&mut self, frame: CoreFrame<'_>, end: u64, context: &mut CoreContext<'_>) {
        self.finish(end, context);
        self.start = self.clocks(frame.offers).edge(self.intake.clocks() - 1);
        let timing = self.schedule.timing();
        self.open_from = self.start + timing.edges_to_ready() + 1;
        let last_clock = self.start + timing.edges_to_step(timing.steps() - 1);
        self.frames += 1;
        context.engine.step_pixels(frame.pixels).expect("the model has checked the frame");
        self.yield_frame(frame.pixels, 0..end.min(self.open_from), context);
        self.unfinished = (last_clock >= self.open_from).then(|| KeptPixels::copy_of(frame.pixels));
    }

    fn finish(&mut self, end: u64, context: &mut CoreContext<'_>) {
        if let Some(pixels) = self.unfinished.take() {
            self.yield_frame(pixels.borrow(), self.open_from..end, context);
        }
    }

    fn reset(&mut self, edge: u64) {
        self.open_from = edge + 1;
        self.frames = 0;
        self.unfinished = None;
    }
}

/// The clocks of the pixels of a frame.
#[derive(Debug)]
pub(super) enum IntakeClocks {
    /// Each pixel takes a clock. The number is that of the pixels of a frame.
    Parallel(u64),
    /// A pixel (x, y) takes c(x) * c(y) clocks. The lists have the sums of c up to each column or
    /// row, and a last element for all.
    Raster { columns: Vec<u64>, rows: Vec<u64> },
}

impl IntakeClocks {
    pub(super) fn new(design: SerialDesign<'_>, pixels: u64) -> Self {
        match design.feed() {
            PixelFeed::Parallel => Self::Parallel(pixels),
            PixelFeed::Raster => {
                let (width, height) = (design.columns(), design.rows());
                let side = design.region_size();
                Self::Raster {
                    columns: sums((0..width * side).map(|x| design.column_places(x))),
                    rows: sums((0..height * side).map(|y| design.row_places(y))),
                }
            }
        }
    }

    /// Returns the clocks from the first pixel of a frame to pixel number `pixel`, if the source
    /// never pauses.
    pub(super) fn place(&self, pixel: u64) -> u64 {
        match self {
            Self::Parallel(_) => pixel,
            Self::Raster { columns, rows } => {
                let width = columns.len() - 1;
                let pixel = usize::try_from(pixel).expect("a pixel of the frame");
                let (x, y) = (pixel % width, pixel / width);
                rows[y] * columns[width] + (rows[y + 1] - rows[y]) * columns[x]
            }
        }
    }

    /// Returns the clocks that the whole frame needs, U'.
    pub(super) fn clocks(&self) -> u64 {
        match self {
            Self::Parallel(pixels) => *pixels,
            Self::Raster { columns, rows } => columns[columns.len() - 1] * rows[rows.len() - 1],
        }
    }
}

fn sums(counts: impl Iterator<Item = u32>) -> Vec<u64> {
    let mut sum = 0;
    let rest = counts.map(|count| {
        sum += u64::from(count);
        sum
    });
    std::iter::once(0).chain(rest).collect()
}

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
