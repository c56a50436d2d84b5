// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tail: the edges at which frames are done, and what happens then. Frames are given to the
//! engine when they are decided. So the frame that leaves is always the engine's last one.

use std::collections::VecDeque;
use std::ops::Range;

use foveate_camera::Periphery;
use foveate_design::PipelinedTiming;
use foveate_pixels::FramePixels;

use crate::payload::KeptPixels;
use crate::timed_core::CoreContext;
use crate::{DecisionRun, RegionRun, SentKind, SentValues, Transaction, WordRun};

/// The tail of all RPUs.
#[derive(Debug)]
pub(super) struct Tail {
    /// The number of frames that must follow before a decision is known.
    decision_frames: u32,
    regions: u32,
    /// The pixels of a region, n.
    pixels: u32,
    periphery: Option<Periphery>,
    /// The frames that were taken and are not decided yet, the oldest first.
    frames: VecDeque<KeptPixels>,
    /// The last decided frame.
    decided: Option<KeptPixels>,
    /// The number of frames that are decided.
    decisions: u64,
    /// The number of frames that are done.
    done: u64,
    /// The position of the next tail step.
    position: u32,
    /// The tail steps of this frame since the last edge without one: the first edge, and the
    /// position of its step.
    run: (u64, u32),
}

impl Tail {
    pub(super) fn new(
        timing: PipelinedTiming,
        regions: u32,
        pixels: u32,
        periphery: Option<Periphery>,
    ) -> Self {
        Self {
            decision_frames: timing.decision_frames,
            regions,
            pixels,
            periphery,
            frames: VecDeque::new(),
            decided: None,
            decisions: 0,
            done: 0,
            position: 0,
            run: (0, 0),
        }
    }

    pub(super) fn reset(&mut self) {
        self.frames.clear();
        self.decided = None;
        (self.decisions, self.done) = (0, 0);
        (self.position, self.run) = (0, (0, 0));
    }

    /// Records a frame whose pixels come to the windows.
    pub(super) fn push_frame(&mut self, pixels: FramePixels<'_>) {
        self.frames.push_back(KeptPixels::copy_of(pixels));
    }

    /// Applies the tail steps at these edges.
    pub(super) fn step(&mut self, edges: impl Iterator<Item = u64>, context: &mut CoreContext<'_>) {
        for edge in edges {
            let (first, position) = self.run;
            let is_consecutive = first + u64::from(self.position - position) == edge;
            if self.position == position || !is_consecutive {
                self.send_run(context);
                self.run = (edge, self.position);
            }
            self.position += 1;
            if self.position == self.pixels {
                self.send_run(context);
                self.finish_frame(edge, context);
                (self.position, self.run) = (0, (0, 0));
            }
        }
    }

    /// Yields what leaves at the tail steps of the run: pixels at every step, means at the last
    /// pixels of their blocks.
    pub(super) fn send_run(&mut self, context: &mut CoreContext<'_>) {
        let (clock, first) = self.run;
        let positions = first..self.position;
        self.run = (clock, self.position);
        if positions.is_empty() || self.decided.is_none() {
            return;
        }
        let words = self.position - first;
        let is_last = self.position == self.pixels;
        self.send(SentKind::Pixels, clock, first, (words, is_last), context);
        let Some(periphery) = self.periphery else { return };
        for mean in means_in(&periphery, &positions) {
            let position = last_position(&periphery, mean);
            let clock = clock + u64::from(position - first);
            let is_last = mean + 1 == periphery.mean_count();
            self.send(SentKind::Means, clock, mean, (1, is_last), context);
        }
    }

    fn send(
        &self,
        kind: SentKind,
        clock: u64,
        first: u32,
        (words, is_last): (u32, bool),
        context: &mut CoreContext<'_>,
    ) {
        let Some(raw) = &self.decided else { return };
        (context.visit)(&Transaction::Words(WordRun {
            frame: self.decisions - 1,
            kind,
            regions: self.all_regions(clock),
            first,
            words,
            word_step: 1,
            is_last,
            is_aborted: false,
            actions: Some(&context.engine.outcome().actions),
            values: SentValues::of_last_frame(context.engine, raw.borrow(), 1),
        }));
    }

    /// Decides a frame: the one that is done, or with a second pass the one before it.
    fn finish_frame(&mut self, clock: u64, context: &mut CoreContext<'_>) {
        self.done += 1;
        if self.done <= self.decision_frames.into() {
            return;
        }
        let frame = self.frames.pop_front().expect("a frame that is done has been taken");
        context.engine.step_pixels(frame.borrow()).expect("the model has checked the frame");
        self.decided = Some(frame);
        (context.visit)(&Transaction::Decisions(DecisionRun {
            frame: self.decisions,
            regions: self.all_regions(clock),
            outcome: context.engine.outcome(),
        }));
        self.decisions += 1;
    }

    fn all_regions(&self, clock: u64) -> RegionRun {
        RegionRun { clock, region: 0, regions: self.regions, region_step: 1, clock_step: 0 }
    }
}

/// Returns the blocks of a region whose last pixels are at these positions.
fn means_in(periphery: &Periphery, positions: &Range<u32>) -> impl Iterator<Item = u32> {
    let is_in = |mean: &u32| positions.contains(&last_position(periphery, *mean));
    (0..periphery.mean_count()).filter(is_in)
}

/// Returns the position of the last pixel of a block, its lower right one.
fn last_position(periphery: &Periphery, block: u32) -> u32 {
    let (blocks, side) = (periphery.blocks, periphery.block_side);
    let (x, y) = ((block % blocks + 1) * side - 1, (block / blocks + 1) * side - 1);
    y * blocks * side + x
}
