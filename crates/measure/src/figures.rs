// SPDX-License-Identifier: MIT OR Apache-2.0
//! The figures of a tally, for people.

use serde::{Deserialize, Serialize};

use super::fixed_point::{count_to_f64, ratio};
use crate::ErrorTally;
use crate::scores::ScoreTally;

/// The distance of a candidate from the ideal. Shares are of the area (pixels times frames), 0..=1.
/// For two designs with the same regions, and frames of whole regions, these are shares of regions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FidelityFigures {
    /// The number of frames compared. Without frames every share is 0 and every SSIM is 1.
    pub frames: u64,
    /// The errors of the scores that both designs have, in the order of the ideal's features, with
    /// `temporal` last; empty for regions of different sizes.
    pub scores: Vec<ScoreError>,
    /// The share of the area whose region has another SRS.
    pub srs_flips: f64,
    /// The share of the area whose region has another TRS.
    pub trs_flips: f64,
    /// The share of the area whose region has another action on the screen.
    pub action_flips: f64,
    /// The share of the ideal's active area that is not active in the candidate, without the first
    /// frame of every clip, in which every region has changed; 0 without such an area.
    pub missed: f64,
    /// The share of the candidate's active area that is not active in the ideal, without the first
    /// frame of every clip; 0 without such an area.
    pub false_alarms: f64,
    /// The intersection over union of both active areas, over all frames; 1 if both are empty.
    pub active_iou: f64,
    /// The share of the area that is active in the candidate.
    pub active: f64,
    /// The share of the area that is active in the ideal.
    pub ideal_active: f64,
    /// The share of the area of regions whose summary the candidate sends; omitted if it sends
    /// none.
    #[serde(default, skip_serializing_if = "is_zero_share")]
    pub summarized: f64,
    /// The PSNR of the candidate's screen against the ideal's in dB: `10 log10(peak^2 / mse)` with
    /// the mean squared error of all frames, and the peak 2^P - 1 of the ideal; `None` if the
    /// screens are identical.
    pub psnr_ideal: Option<f64>,
    /// The PSNR of the candidate's screen against the input in dB; `None` if they are identical.
    pub psnr_input: Option<f64>,
    /// The SSIM of the candidate's screen against the ideal's, at most 1. It is the mean over
    /// frames of the SSIM that the C code of ffmpeg's filter `ssim` computes. The filter's
    /// assembler code for x86 computes another value, a wrong one, if width / 4 is 2 more than a
    /// multiple of 4. A frame that is less than 8 pixels wide or high is one window.
    pub ssim_ideal: f64,
    /// The SSIM of the candidate's screen against the input, at most 1.
    pub ssim_input: f64,
    /// The staleness of the candidate's screen.
    pub staleness: Staleness,
    /// The share of the relevant regions (times frames) that are stale, 0..=1, as in [`Staleness`],
    /// but compared with the candidate's own denoised frame: what the screen has lost since it was
    /// sent, without the errors of fewer bits and of the filter.
    pub stale_regions: f64,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
fn is_zero_share(share: &f64) -> bool {
    *share == 0.0
}

/// The error |candidate - ideal| of one score over all regions and frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScoreError {
    /// The name of the score: `temporal`, or that of a feature.
    pub feature: String,
    /// The unit of the error: shares of the region's pixels (pixels / n), grey levels of the ideal,
    /// or squared grey levels. Scores of a candidate with fewer bits are scaled up to those of the
    /// ideal.
    pub unit: String,
    /// The largest error.
    pub max: f64,
    /// The mean error.
    pub mean: f64,
    /// The root mean square of the error.
    pub rms: f64,
}

/// The difference between the candidate's screen and the denoised frame of the ideal, in the
/// regions that are relevant in the ideal (SRS = 1). Padding is left out.
///
/// A region is stale in a frame if at least `temporal.min_count` of its pixels differ by more than
/// `temporal.level`, both of the ideal. If `min_count` is 0, one pixel is enough. If fewer than
/// `min_count` pixels lie inside of the frame, all of them must differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Staleness {
    /// The largest difference in grey levels of the ideal.
    pub max: f64,
    /// The mean difference over pixels, in grey levels of the ideal.
    pub mean: f64,
    /// The longest run of frames in which one region was relevant and stale.
    pub longest: u64,
    /// The share of the relevant regions (times frames) that are stale; 0 without relevant regions.
    pub share: f64,
}

impl ErrorTally {
    /// Returns the figures of the tally.
    #[must_use]
    pub fn figures(&self) -> FidelityFigures {
        let Self { frames, areas, stale: staleness, .. } = self;
        let (pixels, active) = (&areas.active.all, &areas.active);
        let share = |area: u64| ratio(area, *pixels, 0.0);
        let union = active.ideal + active.candidate - active.both.min(active.ideal);
        FidelityFigures {
            frames: *frames,
            scores: self.scores.iter().map(score_error).collect(),
            srs_flips: share(areas.srs),
            trs_flips: share(areas.trs),
            action_flips: areas.flips(),
            missed: areas.missed(),
            false_alarms: areas.false_alarms(),
            active_iou: ratio(active.both, union, 1.0),
            active: share(active.candidate),
            ideal_active: share(active.ideal),
            summarized: share(areas.summarized),
            psnr_ideal: self.to_ideal.psnr(*pixels, self.peak),
            psnr_input: self.to_input.psnr(*pixels, self.peak),
            ssim_ideal: self.to_ideal.ssim(*frames),
            ssim_input: self.to_input.ssim(*frames),
            staleness: Staleness {
                max: f64::from(staleness.max),
                mean: ratio(staleness.sum, staleness.pixels, 0.0),
                longest: staleness.longest,
                share: staleness.share(),
            },
            stale_regions: self.stale_to_own.share(),
        }
    }
}

fn score_error(tally: &ScoreTally) -> ScoreError {
    let count = count_to_f64(tally.count.max(1));
    ScoreError {
        feature: tally.feature.clone(),
        unit: tally.unit.clone(),
        max: tally.max.to_f64(),
        mean: tally.sum.to_f64() / count,
        rms: (tally.squares.to_f64() / count).sqrt(),
    }
}
