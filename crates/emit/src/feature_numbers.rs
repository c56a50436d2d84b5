// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers of the features in the parameter `KINDS` of `serial_array.v` and `raster_core.v`,
//! and the properties of features that their parameters depend on.

use foveate_design::{FeatureKind, MeanDivision, SpatialFeature};

/// The number of bits of a feature's number in `KINDS`, which has room for `1 << KIND_BITS`
/// features.
const KIND_BITS: usize = 2;
const _: () =
    assert!(FeatureKind::COUNT <= 1 << KIND_BITS, "widen KINDS where rtl/ has it as a parameter");

/// Returns the value of `KINDS` for a list of features: the first feature has the lowest bits.
pub(crate) fn kinds_value<'a>(
    features: impl DoubleEndedIterator<Item = &'a SpatialFeature>,
) -> String {
    let list =
        features.rev().fold(0, |sum, feature| sum << KIND_BITS | feature_number(feature.kind()));
    format!("{}'d{list}", KIND_BITS << KIND_BITS)
}

/// Returns the mean of a feature if the Verilog sums deviations from a mean for its score;
/// otherwise `None`.
pub(crate) fn deviation_mean(feature: &SpatialFeature) -> Option<&MeanDivision> {
    match feature.kind() {
        FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Variance => None,
        FeatureKind::Mad => feature.mean(),
    }
}

fn feature_number(kind: FeatureKind) -> u32 {
    match kind {
        FeatureKind::Edge => 0,
        FeatureKind::Corner => 1,
        FeatureKind::Mad => 2,
        FeatureKind::Variance => 3,
    }
}
