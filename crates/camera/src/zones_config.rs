// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table `[zones]` of a configuration: areas with classes, the thresholds of `keen` regions,
//! and the level of `off` regions.

use crate::depth;
use crate::{Decimal, FeatureKind, RegionClass};
use serde::{Deserialize, Serialize};

/// The table `[zones]`. A threshold that is left out is that of the camera.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ZonesConfig {
    /// The path of an image with the class of each region or pixel. A reader of files replaces it
    /// by `classes`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<String>,
    /// The codes of classes, a string of digits for each row: one digit for each region, or one for
    /// each pixel of the frame.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub classes: Vec<String>,
    /// The areas whose pixels have a class of their own, in pixels of the frame. They overrule
    /// `classes`. All other pixels have the class of `classes`, or are normal without it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub areas: Vec<AreaConfig>,
    /// The level of the summaries of `off` regions in grey levels, 0..=2^P-1, in place of
    /// `periphery.level`, which it is if it is left out. It is valid only with
    /// `render.irrelevant = "mean"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub off_level: Option<u32>,
    /// The thresholds of `keen` regions.
    #[serde(skip_serializing_if = "KeenConfig::is_empty")]
    pub keen: KeenConfig,
}

/// An entry of `[[zones.areas]]`: the class of the pixels of a rectangle or a polygon. An area
/// overrules the areas before it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AreaConfig {
    /// The class of the pixels.
    pub class: RegionClass,
    /// Left, top, width and height in pixels. Width and height are 1 or more, and the rectangle
    /// lies within the frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rectangle: Option<[u32; 4]>,
    /// Three or more corners in pixels from the left and from the top, within the frame. A pixel
    /// belongs to the polygon if a line from its center to the right crosses an odd number of
    /// sides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polygon: Option<Vec<[u32; 2]>>,
}

/// The thresholds of `keen` regions. They have the ranges of the keys of the camera that they
/// replace.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct KeenConfig {
    /// The thresholds of features of the camera, each feature at most once.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub spatial: Vec<KeenSpatialConfig>,
    /// The thresholds of the temporal score.
    #[serde(skip_serializing_if = "KeenTemporalConfig::is_empty")]
    pub temporal: KeenTemporalConfig,
    /// The level of summaries. It is valid only with `render.irrelevant = "mean"`.
    #[serde(skip_serializing_if = "KeenPeripheryConfig::is_empty")]
    pub periphery: KeenPeripheryConfig,
}

/// The thresholds of one feature in `keen` regions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeenSpatialConfig {
    /// The feature, one of those of the camera.
    pub feature: FeatureKind,
    /// The per-pixel threshold in grey levels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// The per-region threshold, in the unit of `spatial.min_score`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_score: Option<Decimal>,
}

/// The thresholds of the temporal score in `keen` regions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct KeenTemporalConfig {
    /// The per-pixel threshold in grey levels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// The per-region threshold in pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_count: Option<u32>,
}

/// The level of the summaries of `keen` regions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct KeenPeripheryConfig {
    /// The level in grey levels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
}

impl KeenConfig {
    /// Returns true if no key of the table is written.
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl KeenTemporalConfig {
    /// Returns true if no key of the table is written.
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl KeenPeripheryConfig {
    /// Returns true if no key of the table is written.
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl ZonesConfig {
    /// Returns the thresholds that are written, scaled from `from` bits to `to` bits per pixel.
    pub(crate) fn scaled_to_depth(&self, from: u32, to: u32) -> Self {
        let level = |value| depth::scale_level(value, from, to);
        let spatial = |entry: &KeenSpatialConfig| {
            let min_score = |value| depth::scale_min_score(entry.feature, value, from, to);
            KeenSpatialConfig {
                feature: entry.feature,
                level: entry.level.map(level),
                min_score: entry.min_score.map(min_score),
            }
        };
        let KeenConfig { spatial: entries, temporal, periphery } = &self.keen;
        Self {
            map: self.map.clone(),
            classes: self.classes.clone(),
            areas: self.areas.clone(),
            off_level: self.off_level.map(level),
            keen: KeenConfig {
                spatial: entries.iter().map(spatial).collect(),
                temporal: KeenTemporalConfig {
                    level: temporal.level.map(level),
                    min_count: temporal.min_count,
                },
                periphery: KeenPeripheryConfig { level: periphery.level.map(level) },
            },
        }
    }
}
