// SPDX-License-Identifier: MIT OR Apache-2.0
//! The edges at which the stages of an RPU step ([`PipelinedCore`]): a [`Window`] takes pixels
//! and gives centers, and the [`Tail`] is done with frames. Frames are given to the engine when
//! they are decided, so the frame that leaves is always the engine's last one.

use crate::clocks::FrameClocks;
use crate::timed_core::{CoreContext, CoreFrame, TimedCore};
use crate::transaction::KeptPixels;
use crate::{BeatOffer, DecisionRun, RegionRun, SentKind, SentValues, Transaction, WordRun};
use foveate_camera::{Neighborhood, Periphery};
use foveate_design::{Design, PipelinedTiming};
use foveate_pixels::FramePixels;
use std::collections::VecDeque;
use std::ops::Range;

/// All RPUs of a pipelined array. They step at the same edges.
#[derive(Debug)]
pub(crate) struct PipelinedCore {
    /// The pixels of the stream of a region.
    stream_pixels: u64,
    /// The windows in the order of the stages, each with the clocks from its step to that of the
    /// next stage.
    windows: Vec<(Window, u64)>,
    /// The clocks from the pixel port to the tail if there is no window.
    tail_delay: u64,
    /// The edges of tail steps that a reset could still prevent.
    later_steps: Vec<u64>,
    tail: Tail,
}

impl PipelinedCore {
    pub(crate) fn new(design: &Design, timing: PipelinedTiming) -> Self {
        let neighborhood = design.neighborhood();
        let mut windows = Vec::new();
        if design.filter().has_window() {
            let filter_window = Window::new(neighborhood, design.stream_side());
            windows.push((filter_window, u64::from(timing.filter_registers)));
        }
        if design.has_feature_window() {
            windows.push((Window::new(neighborhood, design.denoised_side()), 0));
        }
        Self {
            stream_pixels: design.stream_pixels().into(),
            windows,
            tail_delay: timing.tail_delay.into(),
            later_steps: Vec::new(),
            tail: Tail::new(
                timing,
                design.regions(),
                design.region_pixels(),
                design.periphery().copied(),
            ),
        }
    }

    /// Lets pixels at these edges, and with `flushes` nothing after them, pass all stages. Yields
    /// the transactions before edge `end`.
    fn pass_stages(
        &mut self,
        mut edges: Vec<u64>,
        flushes: bool,
        end: u64,
        context: &mut CoreContext<'_>,
    ) {
        for (window, delay) in &mut self.windows {
            let mut steps = Vec::with_capacity(edges.len() + 1);
            edges.iter().for_each(|&edge| window.take(edge, &mut steps));
            if flushes {
                window.flush(&mut steps);
            }
            steps.iter_mut().for_each(|step| *step += *delay);
            edges = steps;
        }
        self.later_steps.extend(edges.into_iter().map(|edge| edge + self.tail_delay));
        let certain = self.later_steps.partition_point(|&edge| edge < end);
        self.tail.step(self.later_steps.drain(..certain), context);
    }
}

impl TimedCore for PipelinedCore {
    fn open_from(&self) -> u64 {
        0
    }

    fn has_ready_output(&self) -> bool {
        false
    }

    fn take_edge(&self, offers: &[BeatOffer], beat: u64) -> u64 {
        clocks(offers).edge(beat)
    }

    fn take_frame(&mut self, frame: CoreFrame<'_>, end: u64, context: &mut CoreContext<'_>) {
        self.tail.push_frame(frame.pixels);
        let clocks = clocks(frame.offers);
        let edges: Vec<u64> =
            clocks.edges(self.stream_pixels).take_while(|&edge| edge < end).collect();
        self.pass_stages(edges, false, end.min(frame.next), context);
    }

    fn finish(&mut self, end: u64, context: &mut CoreContext<'_>) {
        self.pass_stages(Vec::new(), true, end, context);
        self.tail.send_run(context);
    }

    fn reset(&mut self, _edge: u64) {
        self.windows.iter_mut().for_each(|(window, _)| window.reset());
        self.later_steps.clear();
        self.tail.reset();
    }
}

/// Returns the edges of a frame, which an RPU takes as the source offers it.
fn clocks(offers: &[BeatOffer]) -> FrameClocks {
    FrameClocks::new(0, offers.iter().map(|offer| (offer.beat, offer.clock)))
}

/// A window over a region, between two of its pixels.
#[derive(Clone, Debug)]
pub(super) enum Window {
    Isolated(IsolatedWindow),
    Shared(SharedWindow),
}

/// A window that sees no pixel of another region. It gives a center N + 1 advances after it has
/// taken its pixel, and flushes after the last pixel of a frame.
#[derive(Clone, Debug)]
pub(super) struct IsolatedWindow {
    /// The advances from a pixel to its center, N + 1.
    behind: u64,
    /// The pixels of a frame, n.
    pixels: u64,
    /// The number of pixels of the frame that were taken, 0..n.
    taken: u64,
    /// The number of centers of the frame before that were not given yet.
    owed: u64,
    /// The edge of the last pixel.
    last: u64,
}

/// A window over a square of pixels. It gives a center when it takes the pixel one row below and
/// one column to the right.
#[derive(Clone, Debug)]
pub(super) struct SharedWindow {
    side: u64,
    /// The number of pixels of the frame that were taken.
    taken: u64,
}

impl Window {
    /// Makes a window over squares of `side` pixels.
    pub(super) fn new(neighborhood: Neighborhood, side: u32) -> Self {
        let side = u64::from(side);
        match neighborhood {
            Neighborhood::Isolated => Self::Isolated(IsolatedWindow {
                behind: side + 1,
                pixels: side * side,
                taken: 0,
                owed: 0,
                last: 0,
            }),
            Neighborhood::Shared => Self::Shared(SharedWindow { side, taken: 0 }),
        }
    }

    /// Takes a pixel at an edge, and appends the edges of the steps up to then.
    pub(super) fn take(&mut self, edge: u64, steps: &mut Vec<u64>) {
        match self {
            Self::Isolated(window) => window.take(edge, steps),
            Self::Shared(window) => steps.extend(window.take().then_some(edge)),
        }
    }

    /// Appends the edges of the steps that come if no pixel follows.
    pub(super) fn flush(&mut self, steps: &mut Vec<u64>) {
        match self {
            Self::Isolated(window) if window.taken == 0 => window.flush(window.owed, steps),
            Self::Isolated(_) | Self::Shared(_) => {}
        }
    }

    pub(super) fn reset(&mut self) {
        match self {
            Self::Isolated(window) => (window.taken, window.owed) = (0, 0),
            Self::Shared(window) => window.taken = 0,
        }
    }
}

impl IsolatedWindow {
    fn take(&mut self, edge: u64, steps: &mut Vec<u64>) {
        if self.taken == 0 {
            // The window has flushed at every edge since the last pixel.
            self.flush(self.owed.min(edge.saturating_sub(self.last + 1)), steps);
        }
        if self.owed > 0 {
            self.owed -= 1;
            steps.push(edge);
        } else if self.taken >= self.behind {
            steps.push(edge);
        }
        self.taken += 1;
        self.last = edge;
        if self.taken == self.pixels {
            (self.taken, self.owed) = (0, self.behind);
        }
    }

    /// Appends the edges of the next flush advances.
    fn flush(&mut self, advances: u64, steps: &mut Vec<u64>) {
        steps.extend(self.last + 1..=self.last + advances);
        self.owed -= advances;
    }
}

impl SharedWindow {
    /// Takes a pixel, and returns true if the window steps.
    fn take(&mut self) -> bool {
        let (x, y) = (self.taken % self.side, self.taken / self.side);
        self.taken = (self.taken + 1) % (self.side * self.side);
        x >= 2 && y >= 2
    }
}

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
