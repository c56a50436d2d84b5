// SPDX-License-Identifier: MIT OR Apache-2.0
//! The closeness of outputs to those of a whole computation, and the goal for it.

use foveate_network::{
    Executor, Network,
    vision::{OutputDistance, index_of_largest},
};
use std::borrow::Cow;

/// The variation of the outputs of a whole computation over the frames of a clip. Differences
/// between clips are not part of it.
#[derive(Clone, Debug, Default)]
struct OutputVariation {
    /// The sum of every output over the frames of this clip.
    sums: Vec<f64>,
    /// The sum of the squares of all outputs of this clip.
    squares: f64,
    /// The number of frames of this clip.
    frames: u64,
    earlier_clips: f64,
}

impl OutputVariation {
    /// Returns the variation of a single frame, from its outputs and the sum of their squares.
    fn of_frame(sums: Vec<f64>, squares: f64) -> Self {
        Self { sums, squares, frames: 1, earlier_clips: 0.0 }
    }

    fn add(&mut self, other: &Self) {
        if self.sums.is_empty() {
            self.sums.resize(other.sums.len(), 0.0);
        }
        self.sums.iter_mut().zip(&other.sums).for_each(|(sum, other)| *sum += other);
        self.squares += other.squares;
        self.frames += other.frames;
    }

    /// Starts the next clip.
    fn next_clip(&mut self) {
        *self = Self { earlier_clips: self.squares_around_means(), ..Self::default() };
    }

    /// Returns the sum of the squared distances of every output from its mean over the frames of
    /// its clip.
    #[allow(clippy::cast_precision_loss, reason = "a mean")]
    fn squares_around_means(&self) -> f64 {
        if self.frames == 0 {
            return self.earlier_clips;
        }
        let of_means: f64 = self.sums.iter().map(|sum| sum * sum).sum();
        self.earlier_clips + (self.squares - of_means / self.frames as f64).max(0.0)
    }
}

/// The closeness of outputs to those of a whole computation, summed over frames.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClosenessTally {
    pub(crate) distance: OutputDistance,
    variation: OutputVariation,
    /// The number of frames in which every output has its largest value at the same position.
    agreeing_frames: u64,
    pub(crate) frames: u64,
}

impl ClosenessTally {
    /// Compares the outputs of one frame. `right` returns a value of the network from a whole
    /// computation.
    pub(crate) fn compare_outputs<'r>(
        network: &Network,
        right: impl Fn(usize) -> Cow<'r, [f32]>,
        found: &Executor<'_>,
    ) -> Self {
        let (mut distance, mut agrees) = (OutputDistance::default(), true);
        let mut sums = Vec::new();
        for &value in network.outputs() {
            let (right, found) = (right(value), found.tensor(value).real_values());
            distance.add(OutputDistance::between(&right, &found).0);
            agrees &= index_of_largest(&right) == index_of_largest(&found);
            sums.extend(right.iter().map(|&value| f64::from(value)));
        }
        let variation = OutputVariation::of_frame(sums, distance.right_squares());
        Self { distance, variation, agreeing_frames: agrees.into(), frames: 1 }
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.distance.add(other.distance);
        self.variation.add(&other.variation);
        self.agreeing_frames += other.agreeing_frames;
        self.frames += other.frames;
    }

    /// Starts the next clip.
    pub(crate) fn next_clip(&mut self) {
        self.variation.next_clip();
    }

    /// Returns the root mean squared difference as a share of the standard deviation of the outputs
    /// over the frames of their clip; 0 without a difference. The share is about 1 for a network
    /// that runs on the first frame alone.
    pub(crate) fn rms_of_variation(&self) -> f64 {
        let varies = self.variation.squares_around_means();
        if self.distance.squared_difference() == 0.0 {
            0.0
        } else {
            (self.distance.squared_difference() / varies).sqrt()
        }
    }

    /// Returns the share of frames in which every output has its largest value at the same
    /// position.
    #[allow(clippy::cast_precision_loss, reason = "a share")]
    pub(crate) fn agreement(&self) -> f64 {
        if self.frames == 0 { 0.0 } else { self.agreeing_frames as f64 / self.frames as f64 }
    }
}

/// The goal for the closeness of outputs to those of a whole computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TuningGoal {
    /// The least share of frames in which every output has its largest value at the position of a
    /// whole computation.
    Agreement(f64),
    /// The least cosine of the angle between all outputs and those of a whole computation.
    Cosine(f64),
    /// The least peak signal-to-noise ratio of all outputs in decibels, with the range of the
    /// outputs as the peak.
    Psnr(f64),
    /// The largest error of all outputs, as a share of their standard deviation over the frames of
    /// their clip.
    Variation(f64),
}

impl TuningGoal {
    /// Returns whether the goal is reached. NaN never reaches it.
    pub(crate) fn is_reached_by(self, found: &ClosenessTally) -> bool {
        match self {
            Self::Agreement(least) => found.agreement() >= least,
            Self::Cosine(least) => found.distance.cosine() >= least,
            Self::Psnr(least) => found.distance.psnr().is_none_or(|psnr| psnr >= least),
            Self::Variation(most) => found.rms_of_variation() <= most,
        }
    }
}

impl std::fmt::Display for TuningGoal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Agreement(least) => write!(f, "agreement={}%", 100.0 * least),
            Self::Cosine(least) => write!(f, "cosine={least}"),
            Self::Psnr(least) => write!(f, "psnr={least}"),
            Self::Variation(most) => write!(f, "variation={}%", 100.0 * most),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clips_that_differ_from_each_other_do_not_vary() {
        let frame = |value: f64| OutputVariation::of_frame(vec![value], value * value);
        let mut variation = OutputVariation::default();
        for clip in [[0.0, 2.0], [10.0, 12.0]] {
            variation.next_clip();
            clip.iter().for_each(|&value| variation.add(&frame(value)));
        }
        // Each clip has two frames, both 1 away from its mean.
        assert_eq!(variation.squares_around_means(), 4.0);
        variation.next_clip();
        assert_eq!(variation.squares_around_means(), 4.0);
    }

    #[test]
    fn what_is_no_number_is_not_close() {
        let (odd, _) = OutputDistance::between(&[1.0, 2.0], &[1.0, f32::NAN]);
        let closeness = ClosenessTally { distance: odd, frames: 1, ..ClosenessTally::default() };
        let goals = [
            TuningGoal::Agreement(0.1),
            TuningGoal::Cosine(-1.0),
            TuningGoal::Psnr(0.0),
            TuningGoal::Variation(1e9),
        ];
        for goal in goals {
            assert!(!goal.is_reached_by(&closeness), "{goal}");
        }
    }

    /// The clip has two frames with two outputs; the second output varies from 1 to 5.
    #[test]
    fn the_error_of_an_output_that_stays_is_its_variation() {
        let frame = |right: [f32; 2], found: [f32; 2]| {
            let (distance, _) = OutputDistance::between(&right, &found);
            let sums = right.map(f64::from).to_vec();
            ClosenessTally {
                variation: OutputVariation::of_frame(sums, distance.right_squares()),
                distance,
                agreeing_frames: 1,
                frames: 1,
            }
        };
        let mut all = frame([7.0, 1.0], [7.0, 3.0]);
        all.add(&frame([7.0, 5.0], [7.0, 3.0]));
        assert_eq!((all.rms_of_variation(), all.agreement()), (1.0, 1.0));
        assert!(
            TuningGoal::Variation(1.0).is_reached_by(&all)
                && !TuningGoal::Variation(0.99).is_reached_by(&all)
        );
        let mut exact = frame([7.0, 1.0], [7.0, 1.0]);
        exact.add(&frame([7.0, 5.0], [7.0, 5.0]));
        assert_eq!(exact.rms_of_variation(), 0.0);
    }
}
