// SPDX-License-Identifier: MIT OR Apache-2.0
//! Explains why a region of a frame was sent or dropped: every pixel, score, threshold and vote, and the
//! row of the decision table that applied.
//!
//! Scores and bits come from the camera, and what it remembered before the frame. The hits are computed per pixel, and
//! their sum must be the score.

mod gather;
mod text;

use foveate_camera::{FeatureKind, Filter};
use serde::Serialize;

/// Rows of pixels.
pub type Rows<T> = Vec<Vec<T>>;

/// Which frame is explained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment<'a> {
    /// Number of the frame.
    pub number: u64,
    /// Its name.
    pub name: &'a str,
    /// Its time in microseconds.
    pub t_us: u64,
}

/// Why a region was sent or dropped.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Version of this format.
    pub format_version: u32,
    /// Fingerprint of the design.
    pub design_fingerprint: String,
    /// Number of the frame.
    pub frame: u64,
    /// Name of the frame.
    pub name: String,
    /// Time of the frame in microseconds.
    pub t_us: u64,
    /// The region.
    pub region: Place,
    /// Bits per pixel.
    pub pixel_bits: u32,
    /// The raw pixels.
    pub raw: Rows<u16>,
    /// The pixels that were scored, with their filter.
    pub denoised: Rows<u16>,
    /// `none` or `median3x3`.
    pub filter: Filter,
    /// Every feature.
    pub spatial: Vec<Spatial>,
    /// How votes become SRS: `any` or `all`.
    pub combine: &'static str,
    /// Spatial relevance.
    pub srs: bool,
    /// The temporal score.
    pub temporal: Change,
    /// Temporal relevance.
    pub trs: bool,
    /// The means of its blocks, where irrelevant regions send them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub summary: Option<Summary>,
    /// The action on the screen: `forward`, `hold`, `blank` or `summarize`.
    pub action: &'static str,
    /// The row of the decision table (Table I of the paper) that applied.
    pub rule: String,
}

/// A region and its pixels in the frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Place {
    /// Column of the region.
    pub x: u32,
    /// Row of the region.
    pub y: u32,
    /// Column of its first pixel.
    pub x0: u32,
    /// Row of its first pixel.
    pub y0: u32,
    /// Pixels along each side.
    pub size: u32,
    /// Columns of regions in a frame.
    pub columns: u32,
    /// Rows of regions in a frame.
    pub rows: u32,
    /// Columns of pixels that are padding.
    pub padding_right: u32,
    /// Rows of pixels that are padding.
    pub padding_below: u32,
}

/// A spatial score and its vote.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spatial {
    /// `edge`, `corner`, `mad` or `variance`.
    pub feature: FeatureKind,
    /// Threshold of a pixel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// Pixels that count, for `edge` and `corner`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hits: Option<Rows<bool>>,
    /// The mean in units of `2^-f` grey levels, for `mad`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean: Option<u64>,
    /// The score.
    pub score: u64,
    /// The least score that votes.
    pub min_score: u64,
    /// Divisor that turns a score into grey levels (squared grey levels for `variance`); 1 for counts.
    pub unit: u64,
    /// Whether it votes.
    pub vote: bool,
}

/// The temporal score.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Change {
    /// The kind of reference: `previous` or `last-sent`.
    pub against: &'static str,
    /// The reference; without a valid one every pixel counts.
    pub reference: Option<Rows<u16>>,
    /// Threshold of a pixel.
    pub level: u32,
    /// Pixels that count.
    pub hits: Rows<bool>,
    /// The number of them.
    pub count: u32,
    /// The least count that makes TRS.
    pub min_count: u32,
}

/// The means of a region's blocks, and those that the screen shows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// The means in this frame.
    pub means: Rows<u16>,
    /// Those that the screen shows before it; `None` where it shows no summary.
    pub shown: Option<Rows<u16>>,
    /// The summary of an irrelevant region is sent when a mean differs by more than this.
    pub level: u32,
}
