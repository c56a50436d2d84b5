// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds of zones in a configuration: those of `keen` regions, and the level of `off`
//! regions.

use crate::depth;
use crate::{Decimal, FeatureKind};
use serde::{Deserialize, Serialize};

/// The thresholds of a camera with zones. A threshold that is left out is that of the camera.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ZonesConfig {
    /// The level of the summaries of `off` regions in grey levels, 0..2^P-1, in place of
    /// `periphery.level`. It is valid only with `render.irrelevant = "mean"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub off_level: Option<u32>,
    /// The thresholds of `keen` regions.
    pub keen: KeenConfig,
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
    pub temporal: KeenTemporalConfig,
    /// The level of summaries. It is valid only with `render.irrelevant = "mean"`.
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
