// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores: the counters, and the registers that hold their values for one more frame with a
//! second pass.
//!
//! ```text
//!                         done(t)              done(t+1)
//! counter           ..  final(t)  0/1 ..      final(t+1)  0/1 ..
//! hold register     ..      -     final(t) .. final(t)    final(t+1) ..
//! mad accumulator   ..      -     |x-mu(t)| ..  mad(t)    |x-mu(t+1)| ..
//! segment           ..      -     0 ..       segment(t)   0 ..
//! ```

use foveate_camera::FeatureKind;

use super::pixel::TailStep;
use super::region_sums::RegionSums;
use super::rpu_parameters::{MAX_FEATURES, RpuParameters};
use crate::conversions::bool_as_count;
use crate::feature::mad;
use crate::feature::segment::{SegmentCounts, side_of_mean};

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

    /// Returns the values of the score ports.
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
