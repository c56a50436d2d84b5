// SPDX-License-Identifier: MIT OR Apache-2.0
//! The part of a configuration file that says what is computed, as serde types: one struct per table, one default
//! per key.
//!
//! The defaults are the paper's camera. Unknown keys are refused before serde sees them, by
//! [`crate::keys`], so that the message can name the nearest known key.

use crate::depth::{self, DEFAULT_BITS};
use crate::{Combine, Decimal, FeatureKind, Filter, Irrelevant, Neighborhood, Payload, Reference};
use serde::{Deserialize, Serialize};

/// The tables of a configuration that say what is computed; see [`CameraConfig::validate`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CameraConfig {
    /// Size and depth of a frame.
    pub frame: FrameConfig,
    /// Size of a region and what its windows see at its border.
    pub region: RegionConfig,
    /// The filter in front of every score.
    pub denoise: DenoiseConfig,
    /// One or more spatial features, each at most once.
    pub spatial: Vec<SpatialConfig>,
    /// How the votes of several features become SRS.
    pub decision: DecisionConfig,
    /// The temporal score and its reference.
    pub temporal: TemporalConfig,
    /// What becomes of a region on the screen.
    pub render: RenderConfig,
    /// What irrelevant regions send, with `render.irrelevant = "mean"`.
    #[serde(skip_serializing_if = "PeripheryConfig::is_empty")]
    pub periphery: PeripheryConfig,
}

impl Default for CameraConfig {
    fn default() -> Self {
        Self {
            frame: FrameConfig::default(),
            region: RegionConfig::default(),
            denoise: DenoiseConfig::default(),
            spatial: vec![SpatialConfig::new(FeatureKind::default())],
            decision: DecisionConfig::default(),
            temporal: TemporalConfig::default(),
            render: RenderConfig::default(),
            periphery: PeripheryConfig::default(),
        }
    }
}

impl CameraConfig {
    /// The same camera at `bits` bits per pixel, 1..=16: thresholds that are written are scaled from the
    /// configuration's own depth, those that are left out stay so.
    #[must_use]
    pub fn at_depth(&self, bits: u32) -> Self {
        let from = self.frame.pixel_bits;
        let mut config = self.clone();
        config.frame.pixel_bits = bits;
        config.temporal.level = self.temporal.level.map(|value| depth::level(value, from, bits));
        config.periphery.level = self.periphery.level.map(|value| depth::level(value, from, bits));
        config.spatial = self.spatial.iter().map(|entry| entry.at_depth(from, bits)).collect();
        config
    }
}

/// `[frame]`: size in pixels and bits per pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FrameConfig {
    /// Width in pixels, 1..=16384; left out it is 224, or the input's when simulating.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width: Option<u32>,
    /// Height in pixels, 1..=16384; left out it is 224, or the input's when simulating.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<u32>,
    /// Bits per pixel P, 1..=16.
    pub pixel_bits: u32,
}

impl Default for FrameConfig {
    fn default() -> Self {
        Self { width: None, height: None, pixel_bits: DEFAULT_BITS }
    }
}

/// `[region]`: side length N and neighborhood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RegionConfig {
    /// Side of a region N in pixels, 2..=64.
    pub size: u32,
    /// What a window sees beyond the region's border.
    pub neighborhood: Neighborhood,
}

impl Default for RegionConfig {
    fn default() -> Self {
        Self { size: 8, neighborhood: Neighborhood::Isolated }
    }
}

/// `[denoise]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DenoiseConfig {
    /// The filter.
    pub filter: Filter,
}

/// `[[spatial]]`: one feature and its thresholds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpatialConfig {
    /// Which feature.
    pub feature: FeatureKind,
    /// Per-pixel threshold of `edge` (default 100) and `corner` (default 20), in grey levels. Defaults in
    /// grey levels are those of 8 bits, scaled to the depth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// Per-region threshold: hits for `edge` and `corner` (default 5), grey levels for `mad`
    /// (default 5), squared grey levels for `variance` (default 50); the last two may be decimal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_score: Option<Decimal>,
    /// Fraction bits of the mean of `mad`, 0..=ceil(log2 n); 0 by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_fraction_bits: Option<u32>,
}

impl SpatialConfig {
    /// The feature with every threshold left at its default.
    #[must_use]
    pub fn new(feature: FeatureKind) -> Self {
        Self { feature, level: None, min_score: None, mean_fraction_bits: None }
    }

    /// Whether `mean_fraction_bits` applies to the feature.
    #[must_use]
    pub fn has_mean(&self) -> bool {
        self.feature.defaults().mean_fraction_bits.is_some()
    }

    /// The entry with every key that applies to its feature filled in, for pixels of `bits` bits.
    #[must_use]
    pub fn with_defaults(&self, bits: u32) -> Self {
        let defaults = self.feature.defaults();
        let level = defaults.level.map(|value| depth::level(value, DEFAULT_BITS, bits));
        let min_score = Decimal::whole(defaults.min_score);
        let min_score = depth::min_score(self.feature, min_score, DEFAULT_BITS, bits);
        Self {
            feature: self.feature,
            level: self.level.or(level),
            min_score: self.min_score.or(Some(min_score)),
            mean_fraction_bits: self.mean_fraction_bits.or(defaults.mean_fraction_bits),
        }
    }

    /// The entry of a configuration of `from` bits for one of `to` bits.
    fn at_depth(&self, from: u32, to: u32) -> Self {
        let min_score = |value| depth::min_score(self.feature, value, from, to);
        Self {
            level: self.level.map(|value| depth::level(value, from, to)),
            min_score: self.min_score.map(min_score),
            ..self.clone()
        }
    }
}

/// `[decision]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DecisionConfig {
    /// How the votes of several features are combined.
    pub combine: Combine,
}

/// `[temporal]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TemporalConfig {
    /// A pixel has changed when it differs by more than this many grey levels, 0..2^P-1; left out it is 8
    /// at 8 bits, scaled to the depth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// TRS is 1 when at least this many pixels have changed, 0..=n.
    pub min_count: u32,
    /// What a frame is compared with.
    pub reference: Reference,
}

impl TemporalConfig {
    /// The level, its default filled in for pixels of `bits` bits.
    #[must_use]
    pub fn level_at(&self, bits: u32) -> u32 {
        self.level.unwrap_or_else(|| depth::level(8, DEFAULT_BITS, bits))
    }
}

impl Default for TemporalConfig {
    fn default() -> Self {
        Self { level: None, min_count: 5, reference: Reference::Previous }
    }
}

/// `[render]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RenderConfig {
    /// What is shown where SRS is 0.
    pub irrelevant: Irrelevant,
    /// Which pixels an active region forwards.
    pub payload: Payload,
}

/// `[periphery]`: the summaries of irrelevant regions. It is there only with `render.irrelevant = "mean"`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PeripheryConfig {
    /// Blocks per side q of a region, 1, 2 or 4, which divides N; left out it is 2 where that divides N, else 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub blocks: Option<u32>,
    /// A summary is sent again when a mean differs by more than this many grey levels, 0..2^P-1; left out it is 4 at
    /// 8 bits, scaled to the depth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
}

impl PeripheryConfig {
    /// Whether it says nothing.
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The blocks per side, their default filled in for regions of `side` pixels a side.
    #[must_use]
    pub fn blocks_of(&self, side: u32) -> u32 {
        self.blocks.unwrap_or(if side.is_multiple_of(2) { 2 } else { 1 })
    }

    /// The level, its default filled in for pixels of `bits` bits.
    #[must_use]
    pub fn level_at(&self, bits: u32) -> u32 {
        self.level.unwrap_or_else(|| depth::level(4, DEFAULT_BITS, bits))
    }
}
