// SPDX-License-Identifier: MIT OR Apache-2.0
//! How the Verilog numbers the features, in parameter `KINDS` of `serial_array.v` and `raster_core.v`, and what its
//! parameters ask of them.

use foveate_design::{FeatureKind, Mean, SpatialFeature};

/// Bits of the number of a feature in `KINDS`, which has a place for each of as many as there are numbers.
const KIND_BITS: usize = 2;
const _: () =
    assert!(FeatureKind::COUNT <= 1 << KIND_BITS, "widen KINDS where rtl/ has it as a parameter");

/// The value of `KINDS` for a list of features: the first has the lowest bits.
pub(crate) fn kinds<'a>(features: impl DoubleEndedIterator<Item = &'a SpatialFeature>) -> String {
    let list = features.rev().fold(0, |sum, feature| sum << KIND_BITS | number(feature.kind()));
    format!("{}'d{list}", KIND_BITS << KIND_BITS)
}

/// The mean from which the Verilog sums deviations, of the feature whose score they are.
pub(crate) fn deviations(feature: &SpatialFeature) -> Option<&Mean> {
    match feature.kind() {
        FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Variance => None,
        FeatureKind::Mad => feature.mean(),
    }
}

fn number(kind: FeatureKind) -> u32 {
    match kind {
        FeatureKind::Edge => 0,
        FeatureKind::Corner => 1,
        FeatureKind::Mad => 2,
        FeatureKind::Variance => 3,
    }
}
