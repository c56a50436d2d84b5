// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tail of an RPU ([`RpuTail`]): positions, scores, temporal score, decision, forwarding.
//!
//! ```text
//! n = 4, no second pass
//! edge              0   1   2   3   4   5   6   7   8
//! tail step        a0  a1  a2  a3   -  b0  b1  b2  b3
//! done (after)      0   0   0   1   0   0   0   0   1
//! decision valid    0   0   0   1   0   0   0   0   1     frame a, frame b
//! active register   0   0   0   0   A   A   A   A   A     taken at the edge after done
//! forward (after)   -   -   -   -   -  a0  a1  a2  a3     if frame a was active
//! ```
//!
//! With a second pass the decision after edge 8 is that of frame a, and its pixels leave while
//! frame c comes in.
//!
//! An irrelevant region may send its means in place of pixels ([`TailSummary`]): the tail keeps
//! the means of the last frames, the means that were sent, and the means that leave.

use super::frame_store::RegionFrameStore;
use super::pixel::{StagePixel, TailStep};
use super::ports::RpuOutput;
use super::rpu_parameters::RpuParameters;
use super::scores::{RelevanceBits, RpuScores, TemporalCounters};
use crate::conversions::index;
use crate::periphery::{ShownSummary, block_means, last_position_of_block};
use crate::thresholds::ClassThresholdInputs;
use foveate_camera::{Payload, RegionAction, RegionClass};

/// The part of an RPU behind the windows.
#[derive(Clone, Debug)]
pub(super) struct RpuTail {
    store: RegionFrameStore,
    registers: TailRegisters,
}

/// The state that a reset clears: everything except the frame store.
#[derive(Clone, Debug, Default)]
struct TailRegisters {
    /// Position of the next tail step, 0..n.
    position: usize,
    /// True if the last edge had the last tail step of a frame.
    done: bool,
    /// The class of the region in the frame of the last tail step.
    class: RegionClass,
    /// The class of the region in the frame before it.
    class_before: RegionClass,
    scores: RpuScores,
    temporal: TemporalCounters,
    periphery: TailSummary,
    /// The temporal count of the frame before, for designs with a second pass.
    held_count: u32,
    /// True if the last decided frame is active.
    active: bool,
    forward: Option<u16>,
}

impl RpuTail {
    pub(super) fn new(plan: &RpuParameters) -> Self {
        Self { store: RegionFrameStore::new(plan), registers: TailRegisters::default() }
    }

    pub(super) fn reset(&mut self) {
        self.registers = TailRegisters::default();
    }

    /// Applies one edge.
    pub(super) fn step(
        &mut self,
        plan: &RpuParameters,
        step: Option<&TailStep>,
        thresholds: ClassThresholdInputs<'_>,
    ) {
        if self.registers.done {
            self.finish(plan, thresholds);
        }
        self.registers.done = false;
        self.registers.forward = None;
        if let Some(step) = step {
            self.take_step(plan, step, thresholds);
        }
    }

    /// Applies the edge that ends the clock of a decision. The registers take the combinational
    /// values before the tail step of the next frame, which can be at the same edge.
    fn finish(&mut self, plan: &RpuParameters, thresholds: ClassThresholdInputs<'_>) {
        let decision = self.decision(plan, thresholds);
        let class = self.decided_class(plan);
        let registers = &mut self.registers;
        registers.held_count = registers.temporal.final_count(plan, decision);
        registers.temporal.finish(plan, decision);
        registers.scores.finish(plan);
        registers.active = decision.is_some_and(RelevanceBits::is_active);
        registers.periphery.finish(plan, decision, thresholds.summary_level(class));
        if registers.active {
            self.store.send_decided(plan);
        }
        self.store.rotate();
    }

    /// Applies a tail step.
    fn take_step(
        &mut self,
        plan: &RpuParameters,
        step: &TailStep,
        thresholds: ClassThresholdInputs<'_>,
    ) {
        let Self { store, registers } = self;
        let position = registers.position;
        let last = position + 1 == plan.pixels;
        let before = registers.temporal.has_previous.then(|| store.previous(position));

        let payload = |pixel: StagePixel| match plan.payload {
            Payload::Denoised => pixel.scored,
            Payload::Raw => pixel.raw,
        };
        let leaving = registers.active.then(|| payload(store.leaving_pixel(plan, position)));
        registers.forward = leaving.or_else(|| registers.periphery.leaving_mean(plan, position));
        registers.periphery.step(plan, payload(step.pixel));
        if position == 0 {
            registers.class_before = registers.class;
            registers.class = step.class;
        }
        let level = thresholds.of(registers.class).temporal_level;
        registers.temporal.step(store, position, step.pixel.scored, level);
        // The second pass takes pixels of the frame before.
        let levels = &thresholds.of(registers.class_before).level;
        registers.scores.step(plan, step, before, last, levels);
        store.write(position, step.pixel);
        registers.position = if last { 0 } else { position + 1 };
        registers.done = last;
    }

    /// Returns the decision of this clock, or `None` if there is none.
    fn decision(
        &self,
        plan: &RpuParameters,
        thresholds: ClassThresholdInputs<'_>,
    ) -> Option<RelevanceBits> {
        // With a second pass, the first frame that is done only starts the second pass.
        let valid =
            self.registers.done && (!plan.second_pass || self.registers.temporal.has_previous);
        valid.then(|| {
            let scores = self.registers.scores.port_scores(plan);
            let (class, count) = (self.decided_class(plan), self.temporal_count(plan));
            RelevanceBits::from_scores(plan, &scores, count, thresholds.of(class)).of_class(class)
        })
    }

    /// Returns the class of the region in the frame that is decided in this clock, in which the
    /// frame of the last tail step is complete.
    fn decided_class(&self, plan: &RpuParameters) -> RegionClass {
        if plan.second_pass { self.registers.class_before } else { self.registers.class }
    }

    fn temporal_count(&self, plan: &RpuParameters) -> u32 {
        if plan.second_pass {
            self.registers.held_count
        } else {
            self.registers.temporal.running_count(plan)
        }
    }

    /// Sets the output ports to their values in this clock.
    pub(super) fn set_output(
        &self,
        plan: &RpuParameters,
        thresholds: ClassThresholdInputs<'_>,
        output: &mut RpuOutput,
    ) {
        let decision = self.decision(plan, thresholds);
        output.decision_valid = decision.is_some();
        output.srs = decision.is_some_and(|decision| decision.srs);
        output.trs = decision.is_some_and(|decision| decision.trs);
        output.active = decision.is_some_and(RelevanceBits::is_active);
        output.summary = decision.is_some_and(|decision| {
            let level = thresholds.summary_level(self.decided_class(plan));
            self.registers.periphery.action(plan, decision, level) == RegionAction::Summarize
        });
        output.scores = self.registers.scores.port_scores(plan);
        output.temporal_count = self.temporal_count(plan);
        output.forward_valid = self.registers.forward.is_some();
        output.forward_pixel = self.registers.forward.unwrap_or_default();
    }
}

/// The means of a region and the state of its summary.
#[derive(Clone, Debug, Default)]
pub(super) struct TailSummary {
    /// The payload of the current frame, as far as it has come.
    current: Vec<u16>,
    /// The means of the last complete frame.
    previous: Vec<u16>,
    /// The summary that the screen shows.
    summary: ShownSummary,
    /// The means that leave while the current frame comes in.
    sent: Option<Vec<u16>>,
}

impl TailSummary {
    /// Applies a tail step. Without a periphery the payload is not needed.
    pub(super) fn step(&mut self, plan: &RpuParameters, payload: u16) {
        if plan.periphery.is_some() {
            self.current.push(payload);
        }
    }

    /// Returns the action on the region whose decision is made in this clock.
    pub(super) fn action(
        &self,
        plan: &RpuParameters,
        decision: RelevanceBits,
        level: u32,
    ) -> RegionAction {
        let RelevanceBits { srs, trs } = decision;
        self.summary.action(plan.irrelevant, srs, trs, &self.decided_means(plan), level)
    }

    /// Returns the means of the frame that is decided in this clock, in which the current frame is
    /// complete.
    fn decided_means(&self, plan: &RpuParameters) -> Vec<u16> {
        if plan.second_pass { self.previous.clone() } else { self.means(plan) }
    }

    fn means(&self, plan: &RpuParameters) -> Vec<u16> {
        let pixels = self.current.iter().copied();
        plan.periphery.map_or(Vec::new(), |periphery| block_means(&periphery, pixels))
    }

    /// Applies the edge after done.
    pub(super) fn finish(
        &mut self,
        plan: &RpuParameters,
        decision: Option<RelevanceBits>,
        level: u32,
    ) {
        self.sent = None;
        if let Some(decision) = decision {
            let (RelevanceBits { srs, trs }, means) = (decision, self.decided_means(plan));
            let action = self.summary.decide(plan.irrelevant, srs, trs, &means, level);
            self.sent = (action == RegionAction::Summarize).then_some(means);
        }
        self.previous = self.means(plan);
        self.current.clear();
    }

    /// Returns the mean that leaves at a tail step: that of the block whose last pixel has this
    /// position.
    pub(super) fn leaving_mean(&self, plan: &RpuParameters, position: usize) -> Option<u16> {
        let (sent, periphery) = (self.sent.as_ref()?, plan.periphery?);
        let mut blocks = (0..).zip(sent);
        let is_whole =
            |&(block, _): &(u32, _)| index(last_position_of_block(&periphery, block)) == position;
        blocks.find(is_whole).map(|(_, &mean)| mean)
    }
}
