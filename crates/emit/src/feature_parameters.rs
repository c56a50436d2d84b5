// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parameters of `serial_array.v` and `raster_core.v` that belong to a feature or to the filter.

use foveate_camera::{DenoiseFilter, FeatureKind};

pub(crate) fn parameter_prefix(kind: FeatureKind) -> String {
    kind.name().to_uppercase()
}

pub(crate) fn filter_number(filter: DenoiseFilter) -> u32 {
    match filter {
        DenoiseFilter::None => 0,
        DenoiseFilter::Median3x3 => 1,
        DenoiseFilter::Switching3x3 => 2,
        DenoiseFilter::Binomial3x3 => 3,
    }
}
