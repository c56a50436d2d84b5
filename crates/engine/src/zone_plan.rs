// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds of the classes of regions, in the form that the kernels need.

use foveate_camera::{Camera, RegionClass};

use crate::feature_passes::{FeaturePasses, FeaturePlan, feature_plans};
use foveate_pixels::lanes::{PixelLane, saturated_threshold};

/// The thresholds of the classes of regions that differ from those of the camera.
#[derive(Clone, Debug)]
pub(crate) struct ZonePlan<T: PixelLane> {
    /// The passes with the levels of keen regions. They are the same passes as those of the camera.
    pub(crate) keen_passes: FeaturePasses<T>,
    /// The features with the minimum scores of keen regions.
    pub(crate) keen_features: Vec<FeaturePlan>,
    /// The level of the temporal score of keen regions.
    pub(crate) keen_level: T,
    pub(crate) keen_min_count: u32,
    keen_summary_level: T,
    off_summary_level: T,
}

impl<T: PixelLane> ZonePlan<T> {
    /// Returns the thresholds of a camera, or `None` if it has no zones.
    pub(crate) fn from_camera(camera: &Camera) -> Option<Self> {
        camera.zones()?;
        let keen = camera.class_thresholds(RegionClass::Keen);
        let off = camera.class_thresholds(RegionClass::Off);
        // Without summaries their levels have no meaning.
        let summary_level = |level: Option<u32>| saturated_threshold(level.unwrap_or(0));
        Some(Self {
            keen_passes: FeaturePasses::from_features(keen.features),
            keen_features: feature_plans(keen.features),
            keen_level: saturated_threshold(keen.temporal_level),
            keen_min_count: keen.min_count,
            keen_summary_level: summary_level(keen.summary_level),
            off_summary_level: summary_level(off.summary_level),
        })
    }

    /// Returns the level of the summaries of a region. `own` is that of the camera.
    #[inline(always)]
    pub(crate) fn summary_level(&self, class: RegionClass, own: T) -> T {
        match class {
            RegionClass::Normal | RegionClass::Always => own,
            RegionClass::Off => self.off_summary_level,
            RegionClass::Keen => self.keen_summary_level,
        }
    }
}
