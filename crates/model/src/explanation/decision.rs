// SPDX-License-Identifier: MIT OR Apache-2.0
//! The explanation of a decision from scores alone, without the pixels of the region and its
//! reference. Its keys are those of a [`RegionExplanation`](super::RegionExplanation), as far as
//! scores tell them.

use foveate_camera::{DenoiseFilter, Displacement, FeatureKind, RegionAction, RegionClass};
use foveate_design::Design;
use serde::Serialize;

use super::RegionPosition;
use super::gather::{FORMAT_VERSION, rule};

/// The results of a region in a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecidedRegion {
    /// Class of the region; normal in a camera without zones.
    pub class: RegionClass,
    /// Scores, one for every feature.
    pub scores: Vec<u64>,
    /// Displacement since the reference, of a camera with `flow`.
    pub displacement: Option<Displacement>,
    /// Number of pixels that have changed.
    pub changed: u32,
    /// Spatial relevance.
    pub srs: bool,
    /// Temporal relevance.
    pub trs: bool,
    /// Action on the screen.
    pub action: RegionAction,
}

/// The explanation of a decision.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct DecisionExplanation {
    /// Version of the format of explanations.
    pub format_version: u32,
    /// Fingerprint of the design.
    pub design_fingerprint: String,
    /// Number of the frame.
    pub frame: u64,
    /// Name of the frame, if it has one.
    pub name: Option<String>,
    /// Time of the frame in microseconds.
    pub t_us: u64,
    /// Position of the region.
    pub region: RegionPosition,
    /// Bits per pixel.
    pub pixel_bits: u32,
    /// The filter before the scores.
    pub filter: DenoiseFilter,
    /// The spatial scores, one for every feature.
    pub spatial: Vec<FeatureVote>,
    /// The rule by which votes become SRS: `any` or `all`.
    pub combine: &'static str,
    /// The class of the region, of a camera with zones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub class: Option<RegionClass>,
    /// Spatial relevance, SRS.
    pub srs: bool,
    /// The temporal score.
    pub temporal: TemporalCount,
    /// Temporal relevance, TRS.
    pub trs: bool,
    /// The action on the screen.
    pub action: &'static str,
    /// The row of the decision table that applied.
    pub rule: String,
}

/// A spatial score with its threshold and its vote.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct FeatureVote {
    /// Kind of the feature.
    pub feature: FeatureKind,
    /// Per-pixel threshold, of features that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// Displacement of the region since its reference, for `flow`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Displacement>,
    /// The score.
    pub score: u64,
    /// The smallest score that votes.
    pub min_score: u64,
    /// Divisor that turns a score into grey levels (squared grey levels for `variance`); 1 for
    /// counts.
    pub unit: u64,
    /// True if the feature votes.
    pub vote: bool,
}

/// The temporal score with its thresholds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct TemporalCount {
    /// The kind of reference: `previous` or `last-sent`.
    pub against: &'static str,
    /// Per-pixel threshold.
    pub level: u32,
    /// Number of pixels that have changed; all of them without a valid reference.
    pub count: u32,
    /// The smallest count that makes TRS 1.
    pub min_count: u32,
}

impl DecisionExplanation {
    /// Explains the decision for a region of frame `number` with this name and time.
    #[must_use]
    pub fn from_scores(
        design: &Design,
        (number, name, t_us): (u64, Option<&str>, u64),
        region: u32,
        decided: &DecidedRegion,
    ) -> Self {
        let camera = design.camera();
        let &DecidedRegion { class, displacement, changed, srs, trs, action, .. } = decided;
        let thresholds = camera.class_thresholds(class);
        let features = thresholds.features.iter().zip(&decided.scores);
        let spatial = features.map(|(feature, &score)| FeatureVote {
            feature: feature.kind(),
            level: feature.level(),
            displacement: feature.radius().and(displacement),
            score,
            min_score: feature.min_score(),
            unit: feature.unit(),
            vote: score >= feature.min_score(),
        });
        Self {
            format_version: FORMAT_VERSION,
            design_fingerprint: design.fingerprint(),
            frame: number,
            name: name.map(str::to_owned),
            t_us,
            region: RegionPosition::of(camera, region),
            pixel_bits: camera.pixel_bits(),
            filter: camera.filter(),
            spatial: spatial.collect(),
            combine: camera.combine().name(),
            class: camera.zones().map(|_| class),
            srs,
            temporal: TemporalCount {
                against: camera.temporal().reference.name(),
                level: thresholds.temporal_level,
                count: changed,
                min_count: thresholds.min_count,
            },
            trs,
            action: action.name(),
            rule: rule(camera, srs, trs, action),
        }
    }
}
