// SPDX-License-Identifier: MIT OR Apache-2.0
//! The agreement of a network over some frames, and its bound for other frames.

use foveate_inference::{ConfidenceIntervals, DetectionCounts, OutputAgreement};
use serde::Serialize;

use super::sampling_error::{frame_group, group_count, group_margin, share_of_others};
use crate::row::count_to_f64;

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
        let by_count = all
            .agreement_count()
            .map_or(1.0, |count| share_of_others(share, count_to_f64(count))[0]);
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
    let without = |left_out: usize| {
        let in_rest = |at: usize| frame_group(at, frames.len()) != left_out;
        let rest = frames.iter().enumerate().filter(|(at, _)| in_rest(*at));
        rest.map(|(_, frame)| frame).sum::<OutputAgreement>().share()
    };
    group_margin(group_count(frames.len()), without)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_frames_do_not_agree() {
        let found = AgreementEstimate::from_frames(&[]);
        assert_eq!((found.frames, found.share, found.expected), (0, 0.0, 0.0));
        assert!(!found.is_upper_bound);
    }
}
