// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tables of a configuration file that say what is computed, as serde types: one struct per
//! table, one default per key.
//!
//! The defaults are those of the paper's camera. [`crate::keys`] refuses unknown keys before serde
//! sees them, so that the message can name the nearest known key.

use crate::depth::{self, DEFAULT_BITS};
use crate::{
    Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, Payload,
    ReferencePolicy, VoteCombination, ZonesConfig,
};
use serde::{Deserialize, Serialize};

/// The tables of a configuration that say what is computed. [`CameraConfig::validate`] checks them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CameraConfig {
    /// Size and depth of a frame.
    pub frame: FrameConfig,
    /// Size of a region, and the pixels that its windows see beyond its border.
    pub region: RegionConfig,
    /// The filter in front of every score.
    pub denoise: DenoiseConfig,
    /// One or more spatial features, each at most once.
    pub spatial: Vec<SpatialConfig>,
    /// The rule by which the votes of several features become SRS.
    pub decision: DecisionConfig,
    /// The temporal score and its reference.
    pub temporal: TemporalConfig,
    /// The pixels that the screen shows of a region, and those that an active region forwards.
    pub render: RenderConfig,
    /// The summaries that irrelevant regions send, with `render.irrelevant = "mean"`.
    #[serde(skip_serializing_if = "PeripheryConfig::is_empty")]
    pub periphery: PeripheryConfig,
    /// The classes of regions and their thresholds, or `None` for a camera without zones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zones: Option<ZonesConfig>,
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
            zones: None,
        }
    }
}

impl CameraConfig {
    /// Returns the configuration of the same camera at `bits` bits per pixel, 1..=16. Thresholds
    /// that are written are scaled from the depth of this configuration. Thresholds that are left
    /// out stay left out.
    #[must_use]
    pub fn scaled_to_depth(&self, bits: u32) -> Self {
        let from = self.frame.pixel_bits;
        let mut config = self.clone();
        config.frame.pixel_bits = bits;
        config.temporal.level =
            self.temporal.level.map(|value| depth::scale_level(value, from, bits));
        config.periphery.level =
            self.periphery.level.map(|value| depth::scale_level(value, from, bits));
        config.spatial =
            self.spatial.iter().map(|entry| entry.scaled_to_depth(from, bits)).collect();
        config.zones = self.zones.as_ref().map(|zones| zones.scaled_to_depth(from, bits));
        config
    }
}

/// Default width and height of a frame in pixels.
const DEFAULT_SIDE: u32 = 224;

/// The table `[frame]`: size in pixels and bits per pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FrameConfig {
    /// Width in pixels, 1..=16384. If it is left out, it is 224, or the width of the input in a
    /// simulation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width: Option<u32>,
    /// Height in pixels, 1..=16384. If it is left out, it is 224, or the height of the input in a
    /// simulation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<u32>,
    /// Bits per pixel P, 1..=16.
    pub pixel_bits: u32,
}

impl FrameConfig {
    /// Returns true if both sides are written. Otherwise the size may be that of an input that is
    /// not known yet.
    pub(crate) fn has_size(&self) -> bool {
        self.width.is_some() && self.height.is_some()
    }

    /// Returns the width and the height in pixels, 224 for one that is left out.
    #[must_use]
    pub fn size_or_default(&self) -> (u32, u32) {
        (self.width.unwrap_or(DEFAULT_SIDE), self.height.unwrap_or(DEFAULT_SIDE))
    }
}

impl Default for FrameConfig {
    fn default() -> Self {
        Self { width: None, height: None, pixel_bits: DEFAULT_BITS }
    }
}

/// The table `[region]`: side length N and neighborhood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RegionConfig {
    /// Side of a region N in pixels, 2..=64.
    pub size: u32,
    /// The pixels that a window sees beyond the border of its region.
    pub neighborhood: Neighborhood,
}

impl Default for RegionConfig {
    fn default() -> Self {
        Self { size: 8, neighborhood: Neighborhood::Isolated }
    }
}

/// The table `[denoise]`: the filter in front of every score.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DenoiseConfig {
    /// The filter in front of every score.
    pub filter: DenoiseFilter,
}

/// An entry of `[[spatial]]`: one feature and its thresholds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpatialConfig {
    /// The kind of the feature.
    pub feature: FeatureKind,
    /// Per-pixel threshold of a feature that counts pixels, in grey levels: 0..=6*(2^P-1)-1 for
    /// `edge`, 0..=2^P-2 for `corner`, and for `segment` 0..=2^(P-1)-1 with fraction bits of the
    /// mean and 0..=2^(P-1)-2 without. With a `min_score` of 0 it may be up to 6*(2^P-1) for
    /// `edge`, and up to 2^P-1 for the other two. The default is that of 8 bits
    /// ([`LevelSpec::default`](crate::LevelSpec)), and is scaled to the depth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// Per-region threshold, in the unit of the feature. In grey levels and their squares it may
    /// be decimal. The default is that of 8 bits ([`FeatureSpec::min_score`](crate::FeatureSpec)),
    /// and is scaled to the depth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_score: Option<Decimal>,
    /// Fraction bits of the mean of `mad` and `segment`, 0..=ceil(log2 n). The default is 0. A
    /// camera with both has one mean, so their values must be equal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_fraction_bits: Option<u32>,
    /// Largest displacement of `flow` in both directions, in pixels, 1..=3 and below N. The default
    /// is 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<u32>,
}

impl SpatialConfig {
    /// Makes an entry for the feature with every threshold at its default.
    #[must_use]
    pub fn new(feature: FeatureKind) -> Self {
        Self { feature, level: None, min_score: None, mean_fraction_bits: None, radius: None }
    }

    /// Returns true if `mean_fraction_bits` applies to the feature.
    #[must_use]
    pub fn has_mean_fraction(&self) -> bool {
        self.feature.has_second_pass()
    }

    /// Returns the entry with every key that applies to its feature filled in, for pixels of `bits`
    /// bits.
    #[must_use]
    pub fn with_defaults(&self, bits: u32) -> Self {
        let spec = self.feature.spec();
        let level = spec.level.as_ref();
        let level = level.map(|level| depth::scale_level(level.default, DEFAULT_BITS, bits));
        let min_score = Decimal::from_whole(spec.min_score);
        let min_score = depth::scale_min_score(self.feature, min_score, DEFAULT_BITS, bits);
        let mean_fraction_bits = self.has_mean_fraction().then_some(0);
        Self {
            feature: self.feature,
            level: self.level.or(level),
            min_score: self.min_score.or(Some(min_score)),
            mean_fraction_bits: self.mean_fraction_bits.or(mean_fraction_bits),
            radius: self.radius.or(self.feature.default_radius()),
        }
    }

    /// Returns the entry with the thresholds that are written scaled from `from` bits to `to` bits
    /// per pixel.
    fn scaled_to_depth(&self, from: u32, to: u32) -> Self {
        let min_score = |value| depth::scale_min_score(self.feature, value, from, to);
        Self {
            level: self.level.map(|value| depth::scale_level(value, from, to)),
            min_score: self.min_score.map(min_score),
            ..self.clone()
        }
    }
}

/// The table `[decision]`: how SRS is derived from the features.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DecisionConfig {
    /// The rule by which the votes of several features become SRS.
    pub combine: VoteCombination,
}

/// The table `[temporal]`: the thresholds and the reference of the temporal score.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TemporalConfig {
    /// A pixel has changed when it differs by more than this many grey levels, 0..=2^P-2, or
    /// 0..=2^P-1 if `min_count` is 0. If the key is left out, it is 8 at 8 bits, scaled to the
    /// depth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// TRS is 1 when at least this many pixels have changed, 0..=n.
    pub min_count: u32,
    /// The reference that a frame is compared with.
    pub reference: ReferencePolicy,
}

impl TemporalConfig {
    /// Returns the level, or its default for pixels of `bits` bits.
    #[must_use]
    pub fn level_or_default(&self, bits: u32) -> u32 {
        self.level.unwrap_or_else(|| depth::scale_level(8, DEFAULT_BITS, bits))
    }
}

impl Default for TemporalConfig {
    fn default() -> Self {
        Self { level: None, min_count: 5, reference: ReferencePolicy::Previous }
    }
}

/// The table `[render]`: the pixels that are shown and forwarded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RenderConfig {
    /// The pixels that the screen shows where SRS is 0.
    pub irrelevant: IrrelevantRendering,
    /// The pixels that an active region forwards.
    pub payload: Payload,
}

/// The table `[periphery]`: the summaries of irrelevant regions. It is valid only with
/// `render.irrelevant = "mean"`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PeripheryConfig {
    /// Blocks per side q of a region, 1, 2 or 4. It divides N. If the key is left out, it is 2
    /// where 2 divides N, else 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub blocks: Option<u32>,
    /// A summary is sent again when a mean differs from the mean that was sent last by more than
    /// this many grey levels, 0..=2^P-2. If the key is left out, it is 4 at 8 bits, scaled to the
    /// depth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
}

impl PeripheryConfig {
    /// Returns true if no key of the table is written.
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the blocks per side, or their default for regions of `side` pixels a side.
    #[must_use]
    pub fn blocks_or_default(&self, side: u32) -> u32 {
        self.blocks.unwrap_or(if side.is_multiple_of(2) { 2 } else { 1 })
    }

    /// Returns the level, or its default for pixels of `bits` bits.
    #[must_use]
    pub fn level_or_default(&self, bits: u32) -> u32 {
        self.level.unwrap_or_else(|| depth::scale_level(4, DEFAULT_BITS, bits))
    }
}
