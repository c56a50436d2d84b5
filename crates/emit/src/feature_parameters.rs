// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parameters of `serial_array.v` and `raster_core.v` that belong to a feature.

use foveate_design::{FeatureKind, MeanDivision, SpatialFeature};

/// Returns the name that the parameters of a feature begin with.
pub(crate) fn parameter_prefix(kind: FeatureKind) -> String {
    kind.name().to_uppercase()
}

/// Returns the mean of a feature if the Verilog sums deviations from a mean for its score;
/// otherwise `None`.
pub(crate) fn deviation_mean(feature: &SpatialFeature) -> Option<&MeanDivision> {
    match feature.kind() {
        FeatureKind::Edge
        | FeatureKind::Corner
        | FeatureKind::Variance
        | FeatureKind::Range
        | FeatureKind::Surface
        | FeatureKind::Segment => None,
        FeatureKind::Mad => feature.mean(),
    }
}
