// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parameters of `serial_array.v` and `raster_core.v` that belong to a feature.

use foveate_design::{FeatureKind, MeanDivision, SpatialFeature};

/// Returns the name that the parameters of a feature begin with.
pub(crate) fn parameter_prefix(kind: FeatureKind) -> String {
    kind.name().to_uppercase()
}

/// Returns the mean that a feature compares pixels with, in a second pass; `None` for other
/// features. It is the same for all features of a design.
pub(crate) fn deviation_mean(feature: &SpatialFeature) -> Option<&MeanDivision> {
    match feature.kind() {
        FeatureKind::Edge
        | FeatureKind::Corner
        | FeatureKind::Variance
        | FeatureKind::Range
        | FeatureKind::Surface => None,
        FeatureKind::Mad | FeatureKind::Segment => feature.mean(),
    }
}
