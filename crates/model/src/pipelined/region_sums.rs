// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums and extremes over the pixels of a region, for `mad`, `segment`, `variance`, `range` and
//! `surface`.
//!
//! ```text
//! tail step                        0    1   ..  n-1   0 (next frame)
//! sum (after)                      x0  x0+x1     0    x0'
//! mean, variance, range, surface   (of the frame before)  | of this frame
//! ```

use super::pixel::TailStep;
use super::rpu_parameters::RpuParameters;
use crate::feature::mean::rounded_mean;
use crate::feature::range::PixelExtremes;
use crate::feature::surface::DisplacementSums;
use crate::feature::variance;

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
