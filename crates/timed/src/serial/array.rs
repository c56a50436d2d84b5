// SPDX-License-Identifier: MIT OR Apache-2.0
//! A serial array between two frames.

use std::ops::Range;

use foveate_design::{SerialDesign, SerialTiming};
use foveate_pixels::FramePixels;

use super::intake::IntakeClocks;
use super::slot::{FrameOutput, SlotSchedule};
use crate::clocks::FrameClocks;
use crate::payload::KeptPixels;
use crate::timed_core::{CoreContext, CoreFrame, TimedCore};
use crate::{BeatOffer, SentValues};

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
