// SPDX-License-Identifier: MIT OR Apache-2.0
//! The threshold inputs of a core, which are the same for every organization.

use foveate_camera::{Camera, FeatureKind, RegionClass};
use foveate_design::Design;

/// The values of the threshold inputs in one clock. Features are numbered in the order of the
/// camera. Elements that the camera does not use are ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ThresholdInputs {
    /// Per-pixel thresholds of `edge`, `corner` and `segment` in grey levels; 0 for other features.
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

/// The inputs of a core with zones in one clock.
#[derive(Clone, Copy, Debug)]
pub struct ZoneInputs<'a> {
    /// Values of `zone_i` of a pipelined core, one per lane. Other cores ignore them.
    pub classes: &'a [RegionClass],
    /// Inputs of the memory of classes of a serial or raster core. A pipelined core ignores them.
    pub map: ClassMapInputs,
    /// The thresholds of keen regions.
    pub keen: &'a ThresholdInputs,
    /// Threshold of the summaries of regions that are off.
    pub off_summary_level: u32,
}

/// The inputs of a memory of classes in one clock; see `docs/zones.md`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClassMapInputs {
    /// Value of `zone_write_i`.
    pub write: bool,
    /// Value of `zone_address_i`.
    pub address: u32,
    /// Value of `zone_word_i`.
    pub word: u32,
    /// Value of `zone_commit_i`.
    pub commit: bool,
}

/// The thresholds of all classes in one clock.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClassThresholdInputs<'a> {
    own: &'a ThresholdInputs,
    keen: &'a ThresholdInputs,
    off_summary_level: u32,
}

impl<'a> ClassThresholdInputs<'a> {
    /// Makes the thresholds of a core that has these inputs. Without zones all classes have the
    /// same thresholds.
    pub(crate) fn new(own: &'a ThresholdInputs, zones: Option<ZoneInputs<'a>>) -> Self {
        Self {
            own,
            keen: zones.map_or(own, |zones| zones.keen),
            off_summary_level: zones.map_or(own.summary_level, |zones| zones.off_summary_level),
        }
    }

    /// Returns the thresholds of a class, except the level of summaries.
    pub(crate) fn of(self, class: RegionClass) -> &'a ThresholdInputs {
        match class {
            RegionClass::Normal | RegionClass::Off | RegionClass::Always => self.own,
            RegionClass::Keen => self.keen,
        }
    }

    pub(crate) fn summary_level(self, class: RegionClass) -> u32 {
        match class {
            RegionClass::Off => self.off_summary_level,
            RegionClass::Normal | RegionClass::Keen | RegionClass::Always => {
                self.of(class).summary_level
            }
        }
    }
}

/// The thresholds of all classes as the constants of a core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ThresholdConstants {
    own: ThresholdInputs,
    keen: ThresholdInputs,
    off_summary_level: u32,
}

impl ThresholdConstants {
    /// Returns the constants, or `None` if the core has thresholds as inputs.
    pub(crate) fn of_design(design: &Design) -> Option<Self> {
        let of_class = |class| ThresholdInputs::of_class(design, class);
        ThresholdInputs::constants(design).map(|own| Self {
            own,
            keen: of_class(RegionClass::Keen),
            off_summary_level: of_class(RegionClass::Off).summary_level,
        })
    }

    pub(crate) fn by_class(&self) -> ClassThresholdInputs<'_> {
        ClassThresholdInputs {
            own: &self.own,
            keen: &self.keen,
            off_summary_level: self.off_summary_level,
        }
    }
}

impl ThresholdInputs {
    /// Returns the thresholds of the configuration of the camera.
    #[must_use]
    pub fn from_camera(camera: &Camera) -> Self {
        Self::of_class(camera, RegionClass::Normal)
    }

    /// Returns the thresholds of a class in the configuration of the camera.
    #[must_use]
    pub fn of_class(camera: &Camera, class: RegionClass) -> Self {
        let own = camera.class_thresholds(class);
        let mut thresholds = Self {
            level: [0; FeatureKind::COUNT],
            min_score: [0; FeatureKind::COUNT],
            temporal_level: own.temporal_level,
            temporal_min_count: own.min_count,
            summary_level: own.summary_level.unwrap_or(0),
        };
        let places = thresholds.level.iter_mut().zip(&mut thresholds.min_score);
        for (feature, (level, min_score)) in own.features.iter().zip(places) {
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
