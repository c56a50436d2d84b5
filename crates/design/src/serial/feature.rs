// SPDX-License-Identifier: MIT OR Apache-2.0
//! The steps of the pass of a feature in a serial array, and the widths of the registers that it
//! uses.

use super::flow::FlowSearch;
use crate::Design;
use foveate_camera::{FeatureKind, SpatialFeature, bits_for};

/// Returns the number of steps of the pass of a feature.
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
