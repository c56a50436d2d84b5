// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a feature takes in a serial array: the steps of its pass, the widths of the registers that it uses.

use super::LaneWidths;
use crate::{Design, FeatureKind, SpatialFeature};

/// Steps of the pass of a feature.
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
    }
}

/// Makes the registers wide enough for a feature.
pub(super) fn widen(widths: &mut LaneWidths, design: &Design, feature: &SpatialFeature) {
    let (pixel, chain) = (design.pixel_bits(), widths.chain);
    match feature.kind() {
        // Three pixels less three others.
        FeatureKind::Edge => widths.at_least(pixel + 3, 0, 0),
        FeatureKind::Corner => {}
        FeatureKind::Mad => {
            let mean = feature.mean().expect("mad has a mean");
            let mean_bits = pixel + mean.fraction_bits;
            let divisor = design.count_bits() + mean_bits - 1;
            widths.at_least((mean.dividend_bits + 1).max(chain), mean_bits, divisor);
        }
        FeatureKind::Variance => {
            let sum = design.pixel_sum_bits();
            let scale = pixel + design.count_bits();
            widths.at_least((sum + 1).max(chain), sum, scale);
        }
    }
}
