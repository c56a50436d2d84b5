// SPDX-License-Identifier: MIT OR Apache-2.0
//! The work of a feature in a serial array: the steps of its pass ([`pass_steps`]), the widths
//! of its registers ([`FeatureRegisterWidths`]), and its arithmetic with means.
//!
//! * [`FlowSearch`] has weights with which sums over different numbers of pixels compare like
//!   their means. The weight of a displacement d is c(d) = a^2 / n(d). Here a is the least
//!   common multiple of the numbers N, N-1, .. N-R of columns that can have a partner, so every
//!   weight is an integer.
//! * [`BlockMeanDivision`] has the bits of a sum that leave a lane, and the arithmetic at the
//!   ports.

use crate::{Design, SerialDesign};
use foveate_camera::{Displacement, FeatureKind, Reciprocal, SpatialFeature, bits_for};

pub(super) fn pass_steps(design: &Design, feature: &SpatialFeature) -> u64 {
    let n = u64::from(design.region_pixels());
    let pixel_bits = u64::from(design.pixel_bits());
    match feature.kind() {
        FeatureKind::Edge => 14 * n,
        FeatureKind::Corner => 36 * n,
        FeatureKind::Mad => {
            let mean = feature.mean().expect("mad has a mean");
            let fraction_bits = mean.fraction_bits;
            2 * n + pixel_bits + 2 * u64::from(fraction_bits) + 3
        }
        FeatureKind::Variance => {
            let ones = u64::from(n.count_ones());
            let (sum, count) = (u64::from(design.pixel_sum_bits()), u64::from(design.count_bits()));
            n + pixel_bits * n * ones + 2 * sum + pixel_bits + count + 2
        }
        FeatureKind::Range => 4 * n + pixel_bits + 2,
        FeatureKind::Surface => 8 * n + 11 * u64::from(design.pixel_sum_bits()) + 5,
        FeatureKind::Segment => 4 * n + 4 * pixel_bits + 9,
        FeatureKind::Flow => {
            let (sum, search) = (u64::from(design.pixel_sum_bits()), flow_search(design, feature));
            let product = u64::from(search.product_bits);
            2 * search.pairs
                + search.displacements * (2 * sum + product + 1)
                + 3 * sum
                + product
                + 3
        }
    }
}

/// Returns the numbers of the search of `flow`.
fn flow_search(design: &Design, feature: &SpatialFeature) -> FlowSearch {
    let radius = feature.radius().expect("flow has a radius");
    FlowSearch::new(radius, design.region_size(), design.pixel_bits())
}

/// Returns true if the lanes compute an operand from the word that they read: a difference from
/// another word, or some of the bits of the word.
pub(super) fn has_computed_operand(feature: &SpatialFeature) -> bool {
    match feature.kind() {
        FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Segment => false,
        FeatureKind::Mad
        | FeatureKind::Variance
        | FeatureKind::Range
        | FeatureKind::Surface
        | FeatureKind::Flow => true,
    }
}

/// Returns true if the score of a lane takes the accumulator, or is cleared with it.
pub(super) fn takes_accumulator(feature: &SpatialFeature) -> bool {
    match feature.kind() {
        FeatureKind::Edge | FeatureKind::Corner => false,
        FeatureKind::Mad
        | FeatureKind::Variance
        | FeatureKind::Range
        | FeatureKind::Surface
        | FeatureKind::Segment
        | FeatureKind::Flow => true,
    }
}

/// Returns the bits that the word of the ring needs for a feature besides those of its score.
pub(super) fn chain_bits(design: &Design, feature: &SpatialFeature) -> u32 {
    match feature.kind() {
        FeatureKind::Edge
        | FeatureKind::Corner
        | FeatureKind::Mad
        | FeatureKind::Variance
        | FeatureKind::Range
        | FeatureKind::Surface
        | FeatureKind::Flow => 0,
        // The word holds the number of pixels above plus the number of those that are not below. It
        // is at most 2n - 1, because no mean has all pixels of its region above it.
        FeatureKind::Segment => bits_for(u64::from(2 * design.region_pixels() - 1)),
    }
}

/// The widths of registers that a feature needs, in bits. A register that it does not use has 0.
#[derive(Default)]
pub(super) struct FeatureRegisterWidths {
    pub(super) accumulator: u32,
    pub(super) second: u32,
    pub(super) scale: u32,
}

/// Returns the widths of the registers of a feature, in an array whose ring of lanes has words of
/// `chain` bits.
pub(super) fn feature_register_widths(
    design: &Design,
    feature: &SpatialFeature,
    chain: u32,
) -> FeatureRegisterWidths {
    let pixel = design.pixel_bits();
    match feature.kind() {
        // The accumulator holds the sum of three pixels minus that of three others.
        FeatureKind::Edge => {
            FeatureRegisterWidths { accumulator: pixel + 3, ..FeatureRegisterWidths::default() }
        }
        FeatureKind::Corner => FeatureRegisterWidths::default(),
        FeatureKind::Mad => {
            let mean = feature.mean().expect("mad has a mean");
            let second = pixel + mean.fraction_bits;
            FeatureRegisterWidths {
                accumulator: (mean.dividend_bits + 1).max(chain),
                second,
                // The scale holds the shifted divisor.
                scale: design.count_bits() + second - 1,
            }
        }
        FeatureKind::Variance => {
            let sum = design.pixel_sum_bits();
            FeatureRegisterWidths {
                accumulator: (sum + 1).max(chain),
                second: sum,
                scale: pixel + design.count_bits(),
            }
        }
        // The accumulator holds the difference of a pixel from the largest so far.
        FeatureKind::Range => FeatureRegisterWidths {
            accumulator: (pixel + 1).max(chain),
            second: pixel,
            scale: pixel,
        },
        // The accumulator holds the difference of two sums. The second word holds the smallest.
        FeatureKind::Surface => {
            let sum = design.pixel_sum_bits();
            FeatureRegisterWidths { accumulator: (sum + 1).max(chain), second: sum, scale: sum }
        }
        // The accumulator holds a sum times its weight. The second word holds a sum or the score,
        // and the scale a weight that is shifted to the places of a sum.
        FeatureKind::Flow => {
            let (sum, search) = (design.pixel_sum_bits(), flow_search(design, feature));
            FeatureRegisterWidths {
                accumulator: (search.product_bits + 1).max(chain),
                second: sum,
                scale: (2 * search.factor_bits + sum - 1).max(search.product_bits),
            }
        }
        // The accumulator holds the sum of the region and half of n. The second word holds the
        // mean without its fraction.
        FeatureKind::Segment => {
            let n = u64::from(design.region_pixels());
            let dividend = n * ((1 << pixel) - 1) + n / 2;
            FeatureRegisterWidths {
                accumulator: (bits_for(dividend) + 1).max(chain),
                second: pixel,
                // The scale holds the shifted divisor.
                scale: design.count_bits() + pixel - 1,
            }
        }
    }
}

/// The numbers of the search of `flow` in a serial array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FlowSearch {
    /// The radius R.
    pub radius: u32,
    /// The factors a / (N - i) for i = 0..=R. A weight is the product of two of them.
    pub factors: Vec<u64>,
    /// Bits of a factor.
    pub factor_bits: u32,
    /// Bits of the largest product of a sum and its weight, a^2 * (2^P - 1).
    pub product_bits: u32,
    /// Number of all pairs of pixels of all displacements.
    pub pairs: u64,
    /// Number of displacements.
    pub displacements: u64,
}

impl FlowSearch {
    /// Returns the numbers of a search with the radius in regions with `side` pixels a side of
    /// `pixel_bits` bits.
    pub(super) fn new(radius: u32, side: u32, pixel_bits: u32) -> Self {
        let widths = || (0..=radius).map(|missing| u64::from(side - missing));
        let common = widths().fold(1, least_common_multiple);
        let factors: Vec<_> = widths().map(|width| common / width).collect();
        let all = Displacement::search_order(radius);
        let largest = factors.iter().copied().max().expect("a search has a factor");
        Self {
            radius,
            factor_bits: bits_for(largest),
            factors,
            product_bits: bits_for(common * common * ((1 << pixel_bits) - 1)),
            pairs: all.iter().map(|displacement| displacement.pixel_pairs(side)).sum(),
            displacements: (2 * u64::from(radius) + 1).pow(2),
        }
    }

    /// Returns the bits of a coordinate of a displacement, in two's complement.
    #[must_use]
    pub fn coordinate_bits(&self) -> u32 {
        Displacement::coordinate_bits(self.radius)
    }
}

impl SerialDesign<'_> {
    /// Returns the numbers of the search of `flow`, or `None` if the design does not have it.
    #[must_use]
    pub fn flow_search(&self) -> Option<FlowSearch> {
        let radius = self.displacement_feature()?.radius()?;
        Some(FlowSearch::new(radius, self.region_size(), self.pixel_bits()))
    }
}

fn least_common_multiple(a: u64, b: u64) -> u64 {
    let (mut divisor, mut rest) = (a, b);
    while rest > 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    a / divisor * b
}

/// The arithmetic that makes a mean of the sum of a block in the accumulator of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockMeanDivision {
    /// Bits of the sum of a block plus half of its number of pixels.
    pub sum_bits: u32,
    /// Number of low bits of the sum that stay in the lane.
    pub dropped_bits: u32,
    /// Number of the other bits of the sum, which pass the ports.
    pub passing_bits: u32,
    /// Constant factor of the bits that pass.
    pub factor: u64,
    /// Number of bits by which the product is shifted to the right.
    pub shift: u32,
}

impl BlockMeanDivision {
    /// Makes the arithmetic for a sum of `sum` bits. With `takes_all`, a lane also moves its whole
    /// accumulator to the score for a feature. It then drops no bits, because that would need a
    /// multiplexer.
    fn from_reciprocal(sum: u32, reciprocal: Reciprocal, takes_all: bool) -> Self {
        let is_shift = reciprocal.multiplier() == 1;
        let dropped = if is_shift && !takes_all { reciprocal.shift() } else { 0 };
        let (factor, shift) = (reciprocal.multiplier(), reciprocal.shift() - dropped);
        Self { sum_bits: sum, dropped_bits: dropped, passing_bits: sum - dropped, factor, shift }
    }
}

impl SerialDesign<'_> {
    /// Returns the arithmetic of the means of blocks, or `None` if no means are sent.
    #[must_use]
    pub fn block_mean_division(&self) -> Option<BlockMeanDivision> {
        let periphery = self.periphery()?;
        let takes_all = self.features().iter().any(takes_accumulator);
        Some(BlockMeanDivision::from_reciprocal(
            periphery.sum_bits,
            periphery.reciprocal,
            takes_all,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_integers_that_make_sums_comparable() {
        for side in 4..=64 {
            for radius in 1..=3 {
                let search = FlowSearch::new(radius, side, 16);
                let weight = |Displacement { dx, dy }: Displacement| {
                    let factor = |shift: i8| search.factors[usize::from(shift.unsigned_abs())];
                    factor(dx) * factor(dy)
                };
                let order = Displacement::search_order(radius);
                let product = |&d: &Displacement| weight(d) * d.pixel_pairs(side);
                assert!(order.iter().all(|d| product(d) == product(&order[0])), "{side} {radius}");
                let largest = product(&order[0]) * 65_535;
                assert_eq!(search.product_bits, bits_for(largest), "{side} {radius}");
                let row = u64::from(side * (2 * radius + 1) - radius * (radius + 1));
                assert_eq!(search.pairs, row * row);
            }
        }
        let eight = FlowSearch::new(3, 8, 8);
        assert_eq!(eight.factors, [105, 120, 140, 168]);
        assert_eq!((eight.product_bits, eight.displacements, eight.coordinate_bits()), (28, 49, 3));
        assert_eq!(FlowSearch::new(1, 8, 8).coordinate_bits(), 2);
    }
}
