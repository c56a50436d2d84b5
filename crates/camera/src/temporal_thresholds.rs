// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check of the thresholds of a temporal score: those of the camera, or those of keen regions.

use crate::depth::{self, DEFAULT_BITS};
use crate::ranges::{check_range, largest_level};
use crate::{CameraConfig, ConfigError};

/// Checks the thresholds of a temporal score, whose keys are in the table `table`. Some pixel must
/// be able to exceed the level, unless the minimum count is 0.
pub(crate) fn check_temporal_thresholds(
    config: &CameraConfig,
    table: &str,
    level: u32,
    min_count: u32,
) -> Result<(), ConfigError> {
    let bits = config.frame.pixel_bits;
    let pixel_max = (1 << bits) - 1;
    let largest = largest_level(pixel_max, min_count == 0);
    let scaled = depth::scale_level(level, DEFAULT_BITS, bits);
    let hint = depth::depth_hint(&level, &scaled, scaled <= largest, bits);
    let why = format!(" for pixels of {bits} bits, which differ by at most {pixel_max}{hint}");
    check_range(&format!("{table}.level"), level, 0..=largest, &why)?;
    let n = config.region.size * config.region.size;
    let region = format!(" for regions of {n} pixels");
    check_range(&format!("{table}.min_count"), min_count, 0..=n, &region)
}
