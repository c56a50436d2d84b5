// SPDX-License-Identifier: MIT OR Apache-2.0
//! Explanations of the decision for a region of a frame: every pixel, score, threshold and vote,
//! and the row of the decision table that applied.
//!
//! Scores, SRS and TRS are those of the model, and the reference is the one that it had before the
//! frame. The hits are computed per pixel, and their sum must be the score.

mod decision;
mod gather;
mod text;

use foveate_camera::{DenoiseFilter, Displacement, FeatureKind, RegionClass};
use serde::Serialize;

use crate::feature::surface::DisplacementSums;

pub use decision::{DecidedRegion, DecisionExplanation, FeatureVote, TemporalCount};

/// A square of values, row by row.
pub type SquareRows<T> = Vec<Vec<T>>;

/// The identification of the frame that is explained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameIdentification<'a> {
    /// Number of the frame.
    pub number: u64,
    /// Name of the frame.
    pub name: &'a str,
    /// Time of the frame in microseconds.
    pub t_us: u64,
}

/// The explanation of the decision for a region.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RegionExplanation {
    /// Version of the format of this explanation.
    pub format_version: u32,
    /// Fingerprint of the design.
    pub design_fingerprint: String,
    /// Number of the frame.
    pub frame: u64,
    /// Name of the frame.
    pub name: String,
    /// Time of the frame in microseconds.
    pub t_us: u64,
    /// Position of the region.
    pub region: RegionPosition,
    /// Bits per pixel.
    pub pixel_bits: u32,
    /// The raw pixels.
    pub raw: SquareRows<u16>,
    /// The pixels that were scored, which are denoised if the camera has a filter.
    pub denoised: SquareRows<u16>,
    /// The filter: `none`, `median3x3`, `switching3x3` or `binomial3x3`.
    pub filter: DenoiseFilter,
    /// The spatial scores, one for every feature.
    pub spatial: Vec<SpatialExplanation>,
    /// The rule by which votes become SRS: `any` or `all`.
    pub combine: &'static str,
    /// The class of the region, of a camera with zones. It decides which thresholds apply, and
    /// whether SRS follows from the votes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub class: Option<RegionClass>,
    /// Spatial relevance, SRS.
    pub srs: bool,
    /// The temporal score.
    pub temporal: TemporalExplanation,
    /// Temporal relevance, TRS.
    pub trs: bool,
    /// The means of the blocks of the region, if irrelevant regions send them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub summary: Option<SummaryExplanation>,
    /// The action on the screen: `forward`, `hold`, `blank` or `summarize`.
    pub action: &'static str,
    /// The row of the decision table (Table I of the paper) that applied.
    pub rule: String,
}

/// The position of a region and of its pixels in the frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RegionPosition {
    /// Column of the region in the grid of regions.
    pub x: u32,
    /// Row of the region in the grid of regions.
    pub y: u32,
    /// Column of the first pixel of the region.
    pub x0: u32,
    /// Row of the first pixel of the region.
    pub y0: u32,
    /// Side of the region in pixels.
    pub size: u32,
    /// Number of columns of regions in a frame.
    pub columns: u32,
    /// Number of rows of regions in a frame.
    pub rows: u32,
    /// Number of columns of the region that are padding.
    pub padding_right: u32,
    /// Number of rows of the region that are padding.
    pub padding_below: u32,
}

/// A spatial score with its threshold and its vote.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpatialExplanation {
    /// Kind of the feature: `edge`, `corner`, `mad`, `variance`, `range`, `surface`, `segment` or
    /// `flow`.
    pub feature: FeatureKind,
    /// Per-pixel threshold, for `edge`, `corner` and `segment`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// True for every pixel that is a hit, for `edge` and `corner`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hits: Option<SquareRows<bool>>,
    /// The mean in units of `2^-f` grey levels, for `mad` and `segment`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean: Option<u64>,
    /// Fraction bits f of the mean, for `mad` and `segment`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_fraction_bits: Option<u32>,
    /// The pixels that lie more than the level above, or below, the mean, for `segment`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parts: Option<SegmentParts>,
    /// The sums of differences from the region moved by one pixel, for `surface`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub displacements: Option<DisplacementSums>,
    /// The displacement of the region since its reference, for `flow`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub displacement: Option<DisplacementExplanation>,
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

/// The displacement that `flow` found, with the differences that its score follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct DisplacementExplanation {
    /// The displacement; 0 without a valid reference.
    #[serde(flatten)]
    pub displacement: Displacement,
    /// The differences from the reference, or `None` if there is no valid one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub differences: Option<ReferenceDifferences>,
}

/// The differences between a region and its reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ReferenceDifferences {
    /// The differences from the reference as it stands: E(0) and n.
    pub still: DifferenceSum,
    /// The differences from the displaced reference: E(d) and n(d).
    pub displaced: DifferenceSum,
}

/// A sum of absolute differences. The mean error is `sum / pixels`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct DifferenceSum {
    /// The sum in grey levels.
    pub sum: u64,
    /// The number of pixels that were compared.
    pub pixels: u64,
}

/// The two parts of a region that `segment` counts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SegmentParts {
    /// True for every pixel above.
    pub above: SquareRows<bool>,
    /// True for every pixel below.
    pub below: SquareRows<bool>,
    /// Number of pixels above.
    pub count_above: u64,
    /// Number of pixels below.
    pub count_below: u64,
}

/// The temporal score with its reference and its thresholds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct TemporalExplanation {
    /// The kind of reference: `previous` or `last-sent`.
    pub against: &'static str,
    /// The pixels of the reference, or `None` if there is no valid one. Then every pixel counts.
    pub reference: Option<SquareRows<u16>>,
    /// Per-pixel threshold.
    pub level: u32,
    /// True for every pixel that has changed.
    pub hits: SquareRows<bool>,
    /// Number of pixels that have changed.
    pub count: u32,
    /// The smallest count that makes TRS 1.
    pub min_count: u32,
}

/// The means of the blocks of a region, and the means that the screen shows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SummaryExplanation {
    /// The means of the region in this frame.
    pub means: SquareRows<u16>,
    /// The means that the screen shows before this frame, or `None` if it shows no summary of the
    /// region.
    pub shown: Option<SquareRows<u16>>,
    /// The summary of an irrelevant region is sent when a mean differs by more than this.
    pub level: u32,
}
