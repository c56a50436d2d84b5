// SPDX-License-Identifier: MIT OR Apache-2.0
//! The agreement of a network over some frames, and its bound for other frames.

use foveate_inference::{ConfidenceIntervals, DetectionCounts, OutputAgreement, wilson_interval};
use serde::Serialize;

/// The number of groups of consecutive frames: consecutive frames show the same objects, so they
/// are not independent.
const FRAME_GROUPS: usize = 8;
/// The quantiles of Student's t for 1 and more degrees of freedom: 19 of 20 values are above the
/// negative of them.
const STUDENT_QUANTILES: [f64; FRAME_GROUPS - 1] =
    [6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895];
/// The quantile of a normal variable: 19 of 20 values are above the negative of it.
const NORMAL_QUANTILE: f64 = 1.645;

/// The agreement of a network behind a camera with the network on whole frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AgreementEstimate {
    /// The number of frames that the network saw.
    pub frames: u64,
    /// The agreement, 0..=1.
    pub share: f64,
    /// The agreement that 19 of 20 sets of as many other frames would exceed, 0..=1, if groups of
    /// frames were independent.
    pub expected: f64,
    /// True if the agreement is only an upper bound, because the network did not see the other
    /// frames.
    #[serde(skip)]
    pub is_upper_bound: bool,
    /// The detections, if they are read.
    pub detections: Option<DetectionCounts>,
    /// The intervals in which the agreement and the shares of detections lie for other frames of
    /// this kind.
    pub intervals: ConfidenceIntervals,
}

impl AgreementEstimate {
    /// Returns the agreement over some frames. Without frames there is no agreement.
    pub(super) fn from_frames(frames: &[OutputAgreement]) -> Self {
        if frames.is_empty() {
            return Self { is_upper_bound: false, ..Self::upper_bound(0.0, 0) };
        }
        let all: OutputAgreement = frames.iter().sum();
        let share = all.share();
        let by_groups = (share - shortfall(frames)).max(0.0);
        let by_count =
            all.agreement_count().map_or(1.0, |count| least_share_of_others(share, count));
        let expected = by_groups.min(by_count);
        let (frames, detections) = (frames.len() as u64, all.detection_counts());
        let intervals = ConfidenceIntervals::new(share, detections, all.agreement_count());
        Self { frames, share, expected, is_upper_bound: false, detections, intervals }
    }

    /// Returns an upper bound: after `frames` frames no more than `share` can be reached.
    pub(super) fn upper_bound(share: f64, frames: u64) -> Self {
        let intervals = ConfidenceIntervals::default();
        Self { frames, share, expected: share, is_upper_bound: true, detections: None, intervals }
    }
}

/// Returns by how much the agreement over as many other frames may be lower, from the differences
/// between groups of frames.
fn shortfall(frames: &[OutputAgreement]) -> f64 {
    let groups = frames.len().min(FRAME_GROUPS);
    if groups < 2 {
        return 0.0;
    }
    let group = |at: usize| at * groups / frames.len();
    let without = |left_out: usize| {
        let rest = frames.iter().enumerate().filter(|(at, _)| group(*at) != left_out);
        rest.map(|(_, frame)| frame).sum::<OutputAgreement>().share()
    };
    // Two sets of frames differ from each other by more than one set differs from the truth: by the
    // square root of 2.
    STUDENT_QUANTILES[groups - 2] * 2.0_f64.sqrt() * jackknife(groups, without)
}

/// Returns the least share that as many other things are likely to agree with, even if all groups
/// happen to be alike: the lower end of Wilson's interval for the difference of two shares.
fn least_share_of_others(share: f64, count: u64) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "a number of things")]
    let half = count as f64 / 2.0;
    if half == 0.0 { share } else { wilson_interval(share, half, NORMAL_QUANTILE)[0] }
}

/// Returns the standard error of a figure over some groups, from its values without each of the
/// groups (jackknife).
fn jackknife(groups: usize, without: impl Fn(usize) -> f64) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "a small number")]
    let count = groups as f64;
    let figures: Vec<f64> = (0..groups).map(without).collect();
    let mean = figures.iter().sum::<f64>() / count;
    let squares: f64 = figures.iter().map(|figure| (figure - mean).powi(2)).sum();
    ((count - 1.0) / count * squares).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The standard error of a mean is the standard deviation over the square root of the number of
    /// values.
    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let values: [f64; 5] = [1.0, 0.5, 1.0, 0.75, 0.25];
        let sum: f64 = values.iter().sum();
        let found = jackknife(5, |left_out| (sum - values[left_out]) / 4.0);
        let squares: f64 = values.iter().map(|value| (value - sum / 5.0).powi(2)).sum();
        assert!((found - (squares / 4.0 / 5.0).sqrt()).abs() < 1e-12, "{found}");
        assert_eq!(jackknife(4, |_| 0.9), 0.0);
    }

    /// Even if all groups are alike, a share of few things is uncertain: the bound is the least
    /// share that a test would not distinguish from the observed share.
    #[test]
    fn few_things_say_little_of_others() {
        for (share, count) in [(0.976, 251_u32), (1.0, 20), (0.5, 7)] {
            let found = least_share_of_others(share, count.into());
            let error = (found * (1.0 - found) * 2.0 / f64::from(count)).sqrt();
            assert!(
                (share - found - NORMAL_QUANTILE * error).abs() < 1e-9,
                "{share} of {count}: {found}"
            );
        }
        assert!(least_share_of_others(0.98, 99) < least_share_of_others(0.98, 990));
        assert_eq!((least_share_of_others(0.0, 9), least_share_of_others(0.9, 0)), (0.0, 0.9));
    }

    #[test]
    fn no_frames_do_not_agree() {
        let found = AgreementEstimate::from_frames(&[]);
        assert_eq!((found.frames, found.share, found.expected), (0, 0.0, 0.0));
        assert!(!found.is_upper_bound);
    }
}
