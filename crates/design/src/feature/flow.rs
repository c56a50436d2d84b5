// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of `flow`. Only `serial` has it, because a search in the reference would multiply
//! the size of an RPU or of a core.
//!
//! [`FlowSearch`] has weights with which sums over different numbers of pixels compare like their
//! means. The weight of a displacement d is c(d) = a^2 / n(d). Here a is the least common multiple
//! of the numbers N, N-1, .. N-R of columns that can have a partner, so every weight is an integer.

use super::{FeatureHardware, FeatureRegisterWidths, SerialFeature};
use crate::{Design, SerialDesign};
use foveate_camera::{Displacement, SpatialFeature, bits_for};

pub(super) const HARDWARE: FeatureHardware = FeatureHardware {
    pipelined: None,
    serial: Some(SerialFeature {
        pass_steps,
        computes_operand: true,
        takes_accumulator: true,
        chain_bits: |_| 0,
        registers,
        rough_luts: 6.0,
    }),
    raster: None,
};

fn pass_steps(design: &Design, feature: &SpatialFeature) -> u64 {
    let (sum, search) = (u64::from(design.pixel_sum_bits()), flow_search(design, feature));
    let product = u64::from(search.product_bits);
    2 * search.pairs + search.displacements * (2 * sum + product + 1) + 3 * sum + product + 3
}

/// The accumulator holds a sum times its weight. The second word holds a sum or the score, and the
/// scale a weight that is shifted to the places of a sum.
fn registers(design: &Design, feature: &SpatialFeature) -> FeatureRegisterWidths {
    let (sum, search) = (design.pixel_sum_bits(), flow_search(design, feature));
    FeatureRegisterWidths {
        accumulator: search.product_bits + 1,
        second: sum,
        scale: (2 * search.factor_bits + sum - 1).max(search.product_bits),
    }
}

fn flow_search(design: &Design, feature: &SpatialFeature) -> FlowSearch {
    let radius = feature.radius().expect("flow has a radius");
    FlowSearch::new(radius, design.region_size(), design.pixel_bits())
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
    pub(crate) fn new(radius: u32, side: u32, pixel_bits: u32) -> Self {
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
