// SPDX-License-Identifier: MIT OR Apache-2.0
//! The figures of a tally, for people.

use serde::{Deserialize, Serialize};

use crate::ErrorTally;
use crate::exact::{ratio, real};
use crate::scores::ScoreTally;

/// How far a candidate is from the ideal. Shares are of area (pixels times frames), 0..=1: for two
/// designs with the same regions and frames of whole regions that is the share of regions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figures {
    /// Frames compared; with none, every share is 0 and every likeness 1.
    pub frames: u64,
    /// Errors of the scores that both designs have, in the order of the ideal's features, `temporal`
    /// last; empty for regions of different sizes.
    pub scores: Vec<ScoreError>,
    /// Share of the area whose region has another SRS.
    pub srs_flips: f64,
    /// Share of the area whose region has another TRS.
    pub trs_flips: f64,
    /// Share of the area whose region is treated differently on the screen.
    pub action_flips: f64,
    /// Share of the area active in the ideal that is not active in the candidate; 0 when there is none.
    pub missed: f64,
    /// Share of the area active in the candidate that is not active in the ideal; 0 when there is none.
    pub false_alarms: f64,
    /// Intersection over union of both active areas, over all frames; 1 when both are empty.
    pub active_iou: f64,
    /// Share of the area that is active in the candidate.
    pub active: f64,
    /// Share of the area that is active in the ideal.
    pub ideal_active: f64,
    /// Share of the area of regions whose summary the candidate sends; left out where it sends none.
    #[serde(default, skip_serializing_if = "is_none")]
    pub summarized: f64,
    /// PSNR of the candidate's screen against the ideal's in dB, `10 log10(peak^2 / mse)` with the mean
    /// squared error of all frames and peak 2^P - 1 of the ideal; `None` where they are identical.
    pub psnr_ideal: Option<f64>,
    /// PSNR of the candidate's screen against the input.
    pub psnr_input: Option<f64>,
    /// SSIM of the candidate's screen against the ideal's, mean over frames of that of ffmpeg's filter
    /// `ssim`; at most 1. (Of its C code: its assembler for x86 errs where width / 4 is 2 more than a
    /// multiple of 4.) A frame less than 8 wide or high is one window.
    pub ssim_ideal: f64,
    /// SSIM of the candidate's screen against the input.
    pub ssim_input: f64,
    /// How old the candidate's screen is.
    pub staleness: Staleness,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
fn is_none(share: &f64) -> bool {
    *share == 0.0
}

/// Error of one score over all regions and frames: |candidate - ideal|.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScoreError {
    /// `edge`, `corner`, `mad`, `variance` or `temporal`.
    pub feature: String,
    /// What the error is in: shares of the region's pixels (hits / n), grey levels of the ideal, or their
    /// squares. Scores of a candidate of fewer bits are scaled up to those of the ideal.
    pub unit: String,
    /// Largest.
    pub max: f64,
    /// Mean.
    pub mean: f64,
    /// Root of the mean square.
    pub rms: f64,
}

/// How the candidate's screen differs from the scene as the ideal sees it (denoised), in the regions of
/// the ideal that are relevant there (SRS = 1). Padding is not looked at.
///
/// A region is stale in a frame when at least `temporal.min_count` of its pixels differ by more than
/// `temporal.level`, both of the ideal; at least one pixel where `min_count` is 0, and all where fewer
/// than `min_count` lie inside of the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Staleness {
    /// Largest difference in grey levels of the ideal.
    pub max: f64,
    /// Mean difference over pixels, in grey levels of the ideal.
    pub mean: f64,
    /// Longest run of frames in which one region was relevant and stale.
    pub longest: u64,
    /// Share of the relevant regions (times frames) that are stale; 0 when there is none.
    pub share: f64,
}

impl ErrorTally {
    /// What people read of it.
    #[must_use]
    pub fn figures(&self) -> Figures {
        let Self { frames, pixels, areas, stale, .. } = self;
        let share = |area: u64| ratio(area, *pixels, 0.0);
        let union = areas.ideal + areas.candidate - areas.both.min(areas.ideal);
        Figures {
            frames: *frames,
            scores: self.scores.iter().map(score).collect(),
            srs_flips: share(areas.srs),
            trs_flips: share(areas.trs),
            action_flips: share(areas.action),
            missed: ratio(areas.ideal.saturating_sub(areas.both), areas.ideal, 0.0),
            false_alarms: ratio(areas.candidate.saturating_sub(areas.both), areas.candidate, 0.0),
            active_iou: ratio(areas.both, union, 1.0),
            active: share(areas.candidate),
            ideal_active: share(areas.ideal),
            summarized: share(areas.summarized),
            psnr_ideal: self.to_ideal.psnr(*pixels, self.peak),
            psnr_input: self.to_input.psnr(*pixels, self.peak),
            ssim_ideal: self.to_ideal.ssim(*frames),
            ssim_input: self.to_input.ssim(*frames),
            staleness: Staleness {
                max: f64::from(stale.max),
                mean: ratio(stale.sum, stale.pixels, 0.0),
                longest: stale.longest,
                share: ratio(stale.stale, stale.relevant, 0.0),
            },
        }
    }
}

fn score(tally: &ScoreTally) -> ScoreError {
    let count = real(tally.count.max(1));
    ScoreError {
        feature: tally.feature.clone(),
        unit: tally.unit.clone(),
        max: tally.max.value(),
        mean: tally.sum.value() / count,
        rms: (tally.squares.value() / count).sqrt(),
    }
}
