// SPDX-License-Identifier: MIT OR Apache-2.0
//! The threshold inputs of a core, which are the same for every organization.

use foveate_camera::{Camera, FeatureKind};
use foveate_design::Design;

/// The values of the threshold inputs in one clock. Features are numbered in the order of the
/// camera. Elements that the camera does not use are ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ThresholdInputs {
    /// Per-pixel thresholds of the features that count hits.
    pub level: [u32; FeatureKind::COUNT],
    /// Per-region thresholds in units of the scores.
    pub min_score: [u64; FeatureKind::COUNT],
    /// Per-pixel threshold of the temporal score: a pixel has changed above this difference.
    pub temporal_level: u32,
    /// Per-region threshold of the temporal score: TRS is 1 from this count on.
    pub temporal_min_count: u32,
    /// Threshold of summaries: a summary is sent again if a mean differs by more. It is 0 if
    /// irrelevant regions send no means.
    pub summary_level: u32,
}

impl ThresholdInputs {
    /// Returns the thresholds of the configuration of the camera.
    #[must_use]
    pub fn from_camera(camera: &Camera) -> Self {
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

    /// Returns the thresholds of a core that has them as constants, or `None` if they are inputs.
    pub(crate) fn constants(design: &Design) -> Option<Self> {
        match design.threshold_source() {
            foveate_design::ThresholdSource::Runtime => None,
            foveate_design::ThresholdSource::Constant => Some(Self::from_camera(design)),
        }
    }
}
