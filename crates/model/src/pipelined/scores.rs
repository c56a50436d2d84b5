// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores: the counters, and the registers that hold their values for one more frame with
//! `mad`.
//!
//! ```text
//!                         done(t)              done(t+1)
//! counter           ..  final(t)  0/1 ..      final(t+1)  0/1 ..
//! hold register     ..      -     final(t) .. final(t)    final(t+1) ..
//! mad accumulator   ..      -     |x-mu(t)| ..  mad(t)    |x-mu(t+1)| ..
//! ```

use foveate_design::FeatureKind;

use super::pixel::TailStep;
use super::region_sums::RegionSums;
use super::rpu_parameters::{MAX_FEATURES, RpuParameters};
use crate::feature::mad;

/// The spatial scores of one RPU, by number of the feature.
#[derive(Clone, Debug, Default)]
pub(super) struct RpuScores {
    hits: [u64; MAX_FEATURES],
    sums: RegionSums,
    /// The score of `mad`, which the second pass sums up over the frame before.
    deviations: u64,
    hold_registers: [u64; MAX_FEATURES],
}

impl RpuScores {
    /// Applies a tail step. `before` is the pixel at this position in the frame before, or `None`
    /// if there is none.
    pub(super) fn step(
        &mut self,
        plan: &RpuParameters,
        step: &TailStep,
        before: Option<u16>,
        last: bool,
        n: u64,
    ) {
        for (count, hit) in self.hits.iter_mut().zip(step.hits) {
            *count += crate::conversions::bool_as_count(hit);
        }
        if let Some(before) = before {
            self.deviations += mad::deviation(before, self.sums.mean, plan.fraction_bits);
        }
        self.sums.step(plan, step.pixel.scored, last, n);
    }

    /// Applies the edge after done.
    pub(super) fn finish(&mut self, plan: &RpuParameters) {
        self.hold_registers = self.accumulated_scores(plan);
        self.hits = [0; MAX_FEATURES];
        self.deviations = 0;
    }

    /// Returns the values of the score ports.
    pub(super) fn port_scores(&self, plan: &RpuParameters) -> [u64; MAX_FEATURES] {
        let running = self.accumulated_scores(plan);
        if !plan.second_pass {
            return running;
        }
        let mut shown = self.hold_registers;
        for ((score, running), kind) in shown.iter_mut().zip(running).zip(plan.features) {
            if kind.is_some_and(FeatureKind::has_second_pass) {
                *score = running;
            }
        }
        shown
    }

    /// Returns the current value of every score in its counter or accumulator.
    fn accumulated_scores(&self, plan: &RpuParameters) -> [u64; MAX_FEATURES] {
        let mut scores = [0; MAX_FEATURES];
        for ((score, hits), kind) in scores.iter_mut().zip(self.hits).zip(plan.features) {
            *score = match kind {
                None => 0,
                Some(FeatureKind::Edge | FeatureKind::Corner) => hits,
                Some(FeatureKind::Mad) => self.deviations,
                Some(FeatureKind::Variance) => self.sums.variance,
                Some(FeatureKind::Range) => self.sums.range,
            };
        }
        scores
    }
}
