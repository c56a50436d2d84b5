// SPDX-License-Identifier: MIT OR Apache-2.0
//! The threshold inputs of a core; every organization has the same.

use foveate_camera::{Camera, FeatureKind};
use foveate_design::Design;

/// What is applied to the threshold inputs in one clock. Features are numbered in the order of the
/// camera; places that it does not use are ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Thresholds {
    /// Per-pixel thresholds of the features that count hits.
    pub level: [u32; FeatureKind::COUNT],
    /// Per-region thresholds in units of the scores.
    pub min_score: [u64; FeatureKind::COUNT],
    /// A pixel has changed above this difference.
    pub temporal_level: u32,
    /// TRS from this count on.
    pub temporal_min_count: u32,
    /// A summary is sent again when a mean differs by more; 0 where irrelevant regions send none.
    pub summary_level: u32,
}

impl Thresholds {
    /// The thresholds that the camera was configured with.
    #[must_use]
    pub fn of(camera: &Camera) -> Self {
        let temporal = camera.temporal();
        let mut thresholds = Self {
            level: [0; FeatureKind::COUNT],
            min_score: [0; FeatureKind::COUNT],
            temporal_level: temporal.level,
            temporal_min_count: temporal.min_count,
            summary_level: camera.periphery().map_or(0, |periphery| periphery.level),
        };
        let places = thresholds.level.iter_mut().zip(&mut thresholds.min_score);
        for (feature, (level, min_score)) in camera.features().iter().zip(places) {
            // A feature without a level has no such input.
            *level = feature.level().unwrap_or(0);
            *min_score = feature.min_score();
        }
        thresholds
    }

    /// Those of a core that has them built in; `None` where they are inputs.
    pub(crate) fn constants(design: &Design) -> Option<Self> {
        match design.thresholds() {
            foveate_design::Thresholds::Runtime => None,
            foveate_design::Thresholds::Constant => Some(Self::of(design)),
        }
    }
}
