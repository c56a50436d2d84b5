// SPDX-License-Identifier: MIT OR Apache-2.0
//! The largest thresholds of random cameras, for the tests of the engine and of the ideal camera.

use foveate_camera::{CameraConfig, Decimal, SpatialConfig};

/// Returns the largest level with which some region has a score, and the largest whole minimum. No
/// region has one if pixels of 1 bit are never on both sides of a mean without a fraction.
pub(crate) fn largest_thresholds(
    entry: &SpatialConfig,
    side: u32,
    bits: u32,
) -> (Option<u32>, u32) {
    let counts = entry.feature.score_unit().is_count();
    let least = if counts { Decimal::from_whole(1) } else { Decimal::from_billionths(1) };
    let level = counts.then_some(0);
    let spatial = vec![SpatialConfig { level, min_score: Some(least), ..entry.clone() }];
    let mut config = CameraConfig { spatial, ..CameraConfig::default() };
    (config.region.size, config.frame.pixel_bits) = (side, bits);
    config.validate().map_or((level, 0), |camera| {
        let feature = &camera.features()[0];
        let minimum = u32::try_from(feature.score_max() / feature.unit());
        (feature.largest_level(), minimum.expect("at most the square of a pixel"))
    })
}
