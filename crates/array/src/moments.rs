// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums over the regions, for `mad` and `variance`, a row of lanes each.

use foveate_design::FeatureKind;
use foveate_lanes::{BLOCK, Block, Lane};

use crate::plan::Plan;
use crate::rows::{Row, row};
use crate::wide::Sum;

/// Accumulators, and the results of the last complete frame; what no feature asks for is not there.
#[derive(Clone, Debug)]
pub(crate) struct Moments<S: Sum> {
    sum: Row<S>,
    square_sum: Option<Row<S>>,
    mean: Option<Row<S>>,
    /// Variance scores of the last complete frame; empty without the feature.
    pub(crate) variance: Row<S>,
    /// Second pass of `mad` over the frame before; empty without the feature.
    pub(crate) deviations: Row<S>,
    n: u64,
    fraction_bits: u32,
}

impl<S: Sum> Moments<S> {
    /// `None` where no feature needs sums.
    pub(crate) fn of(plan: &Plan) -> Option<Self> {
        let has = |kind| plan.place(kind).is_some();
        let (mad, variance) = (has(FeatureKind::Mad), has(FeatureKind::Variance));
        let lanes = |wanted: bool| row(if wanted { plan.lanes } else { 0 });
        (mad || variance).then(|| Self {
            sum: row(plan.lanes),
            square_sum: variance.then(|| row(plan.lanes)),
            mean: mad.then(|| row(plan.lanes)),
            variance: lanes(variance),
            deviations: lanes(mad),
            n: plan.pixels as u64,
            fraction_bits: plan.fraction_bits,
        })
    }

    /// The scores of a feature: where they are formed, or where the variance is held for the second pass.
    pub(crate) fn scores<'a>(
        &'a self,
        kind: FeatureKind,
        held_variance: Option<&'a Row<S>>,
    ) -> &'a Row<S> {
        match kind {
            FeatureKind::Mad => &self.deviations,
            FeatureKind::Variance => held_variance.unwrap_or(&self.variance),
            FeatureKind::Edge | FeatureKind::Corner => unreachable!("{kind} counts hits"),
        }
    }

    pub(crate) fn reset(&mut self) {
        let Self { sum, square_sum, mean, variance, deviations, .. } = self;
        for row in [Some(sum), square_sum.as_mut(), mean.as_mut(), Some(variance), Some(deviations)]
            .into_iter()
            .flatten()
        {
            row.fill(S::default());
        }
    }

    /// The edge after done.
    pub(crate) fn finish(&mut self) {
        self.deviations.fill(S::default());
    }

    /// A tail step; `before` are the pixels at this position in the frame before, if there is one, and
    /// `last` says that it is the last of the frame.
    #[inline(always)]
    pub(crate) fn step<T: Lane>(
        &mut self,
        now: &[Block<T>],
        before: Option<&[Block<T>]>,
        last: bool,
    ) {
        if let (Some(mean), Some(before)) = (&self.mean, before) {
            let rows = self.deviations.blocks_mut().iter_mut().zip(mean.blocks()).zip(before);
            for ((sums, mean), before) in rows {
                for lane in 0..BLOCK {
                    sums[lane] =
                        sums[lane].add_deviation(before[lane], mean[lane], self.fraction_bits);
                }
            }
        }
        for (sums, now) in self.sum.blocks_mut().iter_mut().zip(now) {
            for lane in 0..BLOCK {
                sums[lane] = sums[lane].add(now[lane]);
            }
        }
        if let Some(square_sum) = &mut self.square_sum {
            for (sums, now) in square_sum.blocks_mut().iter_mut().zip(now) {
                for lane in 0..BLOCK {
                    sums[lane] = sums[lane].add_square(now[lane]);
                }
            }
        }
        if last {
            self.conclude();
        }
    }

    /// A frame is complete: its results, and sums that start anew.
    fn conclude(&mut self) {
        let Self { sum, square_sum, mean, variance, n, fraction_bits, .. } = self;
        if let Some(mean) = mean {
            for (mean, sum) in mean.iter_mut().zip(sum.iter()) {
                *mean = sum.mean(*n, *fraction_bits);
            }
        }
        if let Some(square_sum) = square_sum {
            let sums = sum.iter().zip(square_sum.iter());
            for (variance, (&sum, &square_sum)) in variance.iter_mut().zip(sums) {
                *variance = S::variance(sum, square_sum, *n);
            }
            square_sum.fill(S::default());
        }
        sum.fill(S::default());
    }
}
