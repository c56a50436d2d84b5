// SPDX-License-Identifier: MIT OR Apache-2.0
//! Explains why a region of a frame was sent or dropped: every pixel, score, threshold and vote, and the
//! row of the decision table that applied.
//!
//! The earlier frames run through the same camera, so reference and screen are as in the run. Scores and
//! bits come from the camera. The hits are computed per pixel, and their sum must be the score.

mod gather;
mod text;

use foveate_design::{Config, FeatureKind, Filter};
use foveate_model::FunctionalCamera;
use serde::Serialize;

use self::gather::Before;
use crate::SimulatorError;
use foveate_footage::{Kind, Source};

/// Rows of pixels.
pub type Rows<T> = Vec<Vec<T>>;

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

/// Runs a source up to frame `frame` and explains the region at column and row `region`.
///
/// # Errors
/// When there is no such frame or region, or a frame cannot be read.
pub fn explain(
    config: &Config,
    mut source: Box<dyn Source>,
    frame: u64,
    region: (u32, u32),
) -> Result<Explanation, SimulatorError> {
    let (width, height) = source.size();
    let design = config.for_frames(width, height)?;
    let (columns, rows) = (design.columns(), design.rows());
    let (x, y) = region;
    if x >= columns || y >= rows {
        return Err(SimulatorError::NoSuchRegion { x, y, columns, rows });
    }
    let number = y * columns + x;
    let mut camera = FunctionalCamera::new(&design);
    let mut frames = 0;
    loop {
        let Some(current) = source.next_frame()? else {
            let inputs = source.inputs().join(", ");
            return Err(SimulatorError::NoSuchFrame { frame, inputs, frames });
        };
        if source.kind() == Kind::Set {
            camera.reset();
        }
        let reference = camera.reference(number);
        let shown = camera.summary(number).map(<[u16]>::to_vec);
        let outcome = camera.step(&current.frame.to_frame()?)?;
        if frames == frame {
            let before = Before { reference, shown };
            return Ok(gather::explanation(&design, frame, &current, number, before, outcome));
        }
        frames += 1;
    }
}
