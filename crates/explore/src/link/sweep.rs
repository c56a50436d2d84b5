// SPDX-License-Identifier: MIT OR Apache-2.0
//! The design with one threshold at a time set to other values, for the points of its own curves.

use foveate_camera::Decimal;
use foveate_design::{Design, DesignConfig};

/// The values of `temporal.level`, in grey levels of 8 bits.
const LEVELS: [u32; 9] = [0, 1, 2, 4, 8, 16, 32, 64, 128];
/// The values of the first feature's `min_score`, in its own unit; with 0 every region is relevant.
const SCORES: [u64; 8] = [0, 1, 2, 5, 10, 20, 40, 60];

/// A design of a curve.
#[derive(Clone, Debug)]
pub(crate) struct SweptDesign {
    /// The key of the threshold that differs.
    pub(crate) key: &'static str,
    /// The value of the threshold.
    pub(crate) value: u64,
    pub(crate) design: Design,
}

/// Returns the design with other values of `temporal.level` and of `spatial.0.min_score`, each
/// varied alone.
pub(crate) fn swept_designs(config: &DesignConfig) -> Vec<SweptDesign> {
    // A score above the largest one of this design's regions is not valid, and is left out.
    let swept = |key, value, config: DesignConfig| {
        Some(SweptDesign { key, value, design: config.validate().ok()? })
    };
    let level = |&value: &u32| {
        let mut config = config.clone();
        config.camera.temporal.level = Some(value);
        swept("temporal.level", value.into(), config)
    };
    let score = |&value: &u64| {
        let mut config = config.clone();
        config.camera.spatial.first_mut()?.min_score = Some(Decimal::from_whole(value));
        swept("spatial.0.min_score", value, config)
    };
    LEVELS.iter().filter_map(level).chain(SCORES.iter().filter_map(score)).collect()
}
