// SPDX-License-Identifier: MIT OR Apache-2.0
//! From pixels to the decision: the scores of an RPU, and the relevance bits that follow from
//! them.
//!
//! The counters ([`RpuScores`]) have registers that hold their values for one more frame with a
//! second pass.
//!
//! ```text
//!                         done(t)              done(t+1)
//! counter           ..  final(t)  0/1 ..      final(t+1)  0/1 ..
//! hold register     ..      -     final(t) .. final(t)    final(t+1) ..
//! mad accumulator   ..      -     |x-mu(t)| ..  mad(t)    |x-mu(t+1)| ..
//! segment           ..      -     0 ..       segment(t)   0 ..
//! ```
//!
//! `mad`, `segment`, `variance`, `range` and `surface` need sums and extremes over the pixels
//! of a region ([`RegionSums`]).
//!
//! ```text
//! tail step                        0    1   ..  n-1   0 (next frame)
//! sum (after)                      x0  x0+x1     0    x0'
//! mean, variance, range, surface   (of the frame before)  | of this frame
//! ```
//!
//! The temporal score is counted against both possible references ([`TemporalCounters`]).
//!
//! ```text
//!                       frame t-1 active?   reference of frame t
//! previous              -                   x(t-1)
//! last-sent             yes                 x(t-1), now the last one sent
//! last-sent             no                  what was sent before it, if still valid
//! ```
//!
//! Without a second pass the reference is known at the first tail step of frame t. With a
//! second pass it is known when frame t is done, so both counts run.
//!
//! The decision ([`RelevanceBits`]) is combinational: it depends on the score ports and the
//! thresholds of the clock.

use super::frame_store::RegionFrameStore;
use super::pixel::TailStep;
use super::rpu_parameters::{MAX_FEATURES, RpuParameters};
use crate::ThresholdInputs;
use crate::conversions::bool_as_count;
use crate::feature::mean::rounded_mean;
use crate::feature::range::PixelExtremes;
use crate::feature::segment::{SegmentCounts, side_of_mean};
use crate::feature::surface::DisplacementSums;
use crate::feature::{mad, variance};
use crate::region::combine_votes;
use foveate_camera::{FeatureKind, IrrelevantRendering, ReferencePolicy, RegionClass};

/// The spatial scores of one RPU, by number of the feature.
#[derive(Clone, Debug, Default)]
pub(super) struct RpuScores {
    /// The current value of every score in its counter or accumulator.
    running: [u64; MAX_FEATURES],
    sums: RegionSums,
    /// The counts of the second pass of `segment`.
    segment: SegmentCounts,
    hold_registers: [u64; MAX_FEATURES],
}

impl RpuScores {
    /// Applies a tail step. `before` is the pixel at this position in the frame before, or `None`
    /// if there is none. The second pass takes that pixel.
    pub(super) fn step(
        &mut self,
        plan: &RpuParameters,
        step: &TailStep,
        before: Option<u16>,
        last: bool,
        levels: &[u32; MAX_FEATURES],
    ) {
        let (mean_before, fraction_bits) = (self.sums.mean, plan.fraction_bits);
        if plan.needs_sums {
            self.sums.step(plan, step, last);
        }
        let features = plan.features.iter().zip(step.hits).zip(levels);
        for (score, ((&kind, hit), &level)) in self.running.iter_mut().zip(features) {
            match kind {
                None => {}
                Some(FeatureKind::Edge | FeatureKind::Corner) => *score += bool_as_count(hit),
                Some(FeatureKind::Mad) => {
                    let deviation = |before| mad::deviation(before, mean_before, fraction_bits);
                    *score += before.map_or(0, deviation);
                }
                Some(FeatureKind::Segment) => {
                    let side = |before| side_of_mean(before, mean_before, level, fraction_bits);
                    self.segment = before.map_or(self.segment, |one| self.segment.with(side(one)));
                    *score = self.segment.score();
                }
                Some(FeatureKind::Variance) => *score = self.sums.variance,
                Some(FeatureKind::Range) => *score = self.sums.range,
                Some(FeatureKind::Surface) => *score = self.sums.surface,
                Some(FeatureKind::Flow) => unreachable!("pipelined refuses flow"),
            }
        }
    }

    /// Applies the edge after done.
    pub(super) fn finish(&mut self, plan: &RpuParameters) {
        self.hold_registers = self.running;
        self.segment = SegmentCounts::default();
        for (score, kind) in self.running.iter_mut().zip(plan.features) {
            match kind {
                Some(
                    FeatureKind::Edge
                    | FeatureKind::Corner
                    | FeatureKind::Mad
                    | FeatureKind::Segment,
                ) => *score = 0,
                Some(
                    FeatureKind::Variance
                    | FeatureKind::Range
                    | FeatureKind::Surface
                    | FeatureKind::Flow,
                )
                | None => {}
            }
        }
    }

    pub(super) fn port_scores(&self, plan: &RpuParameters) -> [u64; MAX_FEATURES] {
        if !plan.second_pass {
            return self.running;
        }
        let mut shown = self.hold_registers;
        for ((score, running), kind) in shown.iter_mut().zip(self.running).zip(plan.features) {
            if kind.is_some_and(FeatureKind::has_second_pass) {
                *score = running;
            }
        }
        shown
    }
}

/// The accumulators, and the results of the last complete frame.
#[derive(Clone, Debug, Default)]
pub(super) struct RegionSums {
    sum: u64,
    square_sum: u64,
    extremes: PixelExtremes,
    displacements: DisplacementSums,
    /// The mean of the last complete frame, in units of `2^-f`.
    pub(super) mean: u64,
    /// The variance score of the last complete frame.
    pub(super) variance: u64,
    /// The range score of the last complete frame.
    pub(super) range: u64,
    /// The surface score of the last complete frame.
    pub(super) surface: u64,
}

impl RegionSums {
    /// Applies a tail step. `last` is true at position n - 1.
    pub(super) fn step(&mut self, plan: &RpuParameters, step: &TailStep, last: bool) {
        let pixel = step.pixel.scored;
        self.sum += u64::from(pixel);
        self.square_sum += variance::square(pixel);
        self.extremes = self.extremes.with(pixel);
        self.displacements = self.displacements.with(step.differences);
        if last {
            let n = u64::from(plan.pixel_count());
            self.mean = rounded_mean(self.sum, n, plan.fraction_bits);
            self.variance = variance::score(n, self.sum, self.square_sum);
            self.sum = 0;
            self.square_sum = 0;
            self.range = self.extremes.range();
            self.extremes = PixelExtremes::default();
            self.surface = self.displacements.score();
            self.displacements = DisplacementSums::default();
        }
    }
}

/// The relevance bits of a valid decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RelevanceBits {
    pub(super) srs: bool,
    pub(super) trs: bool,
}

impl RelevanceBits {
    pub(super) fn from_scores(
        plan: &RpuParameters,
        scores: &[u64; MAX_FEATURES],
        temporal_count: u32,
        thresholds: &ThresholdInputs,
    ) -> Self {
        let votes = plan
            .features
            .iter()
            .zip(scores.iter().zip(&thresholds.min_score))
            .filter_map(|(kind, (score, min))| kind.map(|_| score >= min));
        Self {
            srs: combine_votes(plan.combine, votes),
            trs: temporal_count >= thresholds.temporal_min_count,
        }
    }

    /// Returns the bits of a region of this class.
    pub(super) fn of_class(self, class: RegionClass) -> Self {
        Self { srs: class.forced_srs().unwrap_or(self.srs), ..self }
    }

    pub(super) fn is_active(self) -> bool {
        self.srs && self.trs
    }
}

/// The counters, and the validity of the references.
#[derive(Clone, Debug, Default)]
pub(super) struct TemporalCounters {
    /// Number of pixels that differ from the previous frame.
    against_previous: u32,
    /// Number of pixels that differ from the last frame that was sent, as far as decisions are
    /// known.
    against_sent: u32,
    /// True if a complete frame has come since reset.
    pub(super) has_previous: bool,
    /// True if the frame that was sent last is a valid reference.
    sent_valid: bool,
}

impl TemporalCounters {
    /// Applies a tail step.
    pub(super) fn step(
        &mut self,
        store: &RegionFrameStore,
        position: usize,
        pixel: u16,
        level: u32,
    ) {
        let differs = |reference: u16| u32::from(pixel.abs_diff(reference)) > level;
        let from_previous = !self.has_previous || differs(store.previous(position));
        let from_sent = !self.sent_valid || differs(store.sent(position));
        self.against_previous += u32::from(from_previous);
        self.against_sent += u32::from(from_sent);
    }

    /// Returns the running count against the reference. It is valid if no later decision can change
    /// the reference.
    pub(super) fn running_count(&self, plan: &RpuParameters) -> u32 {
        match plan.reference {
            ReferencePolicy::Previous => self.against_previous,
            ReferencePolicy::LastSent => self.against_sent,
        }
    }

    /// Returns the count of the frame that is done, for a design with a second pass. The frame
    /// before it is decided now, or does not exist.
    pub(super) fn final_count(&self, plan: &RpuParameters, decision: Option<RelevanceBits>) -> u32 {
        match (plan.reference, decision) {
            (ReferencePolicy::Previous, _) => self.against_previous,
            (ReferencePolicy::LastSent, Some(decision)) if decision.is_active() => {
                self.against_previous
            }
            (ReferencePolicy::LastSent, Some(decision))
                if invalidates_reference(plan, decision) =>
            {
                plan.pixel_count()
            }
            (ReferencePolicy::LastSent, _) => self.against_sent,
        }
    }

    /// Applies the edge after done: counters are cleared, and the references follow the decision.
    pub(super) fn finish(&mut self, plan: &RpuParameters, decision: Option<RelevanceBits>) {
        self.against_previous = 0;
        self.against_sent = 0;
        self.has_previous = true;
        match decision {
            Some(decision) if decision.is_active() => self.sent_valid = true,
            Some(decision) if invalidates_reference(plan, decision) => self.sent_valid = false,
            Some(_) | None => {}
        }
    }
}

/// Returns true if the region becomes black or shows its means, so that the screen no longer shows
/// the pixels that were sent.
fn invalidates_reference(plan: &RpuParameters, decision: RelevanceBits) -> bool {
    match plan.irrelevant {
        IrrelevantRendering::Zero | IrrelevantRendering::Mean => !decision.srs,
        IrrelevantRendering::Hold => false,
    }
}
