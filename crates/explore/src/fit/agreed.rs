// SPDX-License-Identifier: MIT OR Apache-2.0
//! How much a network agrees over some frames, and what that says of others.

use foveate_inference::{Agreement, Found};
use serde::Serialize;

/// Nine of ten values of a normal distribution lie above the mean less so many standard deviations.
const NINE_OF_TEN: f64 = 1.2816;

/// How much of what the network says of whole frames it says behind a camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Agreed {
    /// Frames that it looked at.
    pub frames: u64,
    /// The agreement, 0..=1.
    pub share: f64,
    /// The agreement that nine of ten sets of as many other frames would exceed, if frames were independent: 0..=1.
    pub expected: f64,
    /// Whether the agreement is at most this: the rest was not looked at.
    #[serde(skip)]
    pub at_most: bool,
    /// Detections, if they are read.
    pub detections: Option<Found>,
}

impl Agreed {
    /// That of some frames.
    pub(super) fn over(frames: &[Agreement]) -> Self {
        let all: Agreement = frames.iter().sum();
        let share = all.share();
        // Two sets of frames differ by more than one of them from the truth.
        let short = NINE_OF_TEN * 2.0_f64.sqrt() * standard_error(frames);
        let expected = (share - short).max(0.0);
        let (frames, detections) = (frames.len() as u64, all.found());
        Self { frames, share, expected, at_most: false, detections }
    }

    /// After some frames no more than this share can be reached.
    pub(super) fn at_most(share: f64, frames: u64) -> Self {
        Self { frames, share, expected: share, at_most: true, detections: None }
    }
}

/// The standard error of the agreement over some frames.
fn standard_error(frames: &[Agreement]) -> f64 {
    jackknife(frames.len(), |left_out| {
        let rest = frames.iter().enumerate().filter(|(at, _)| *at != left_out);
        rest.map(|(_, frame)| frame).sum::<Agreement>().share()
    })
}

/// The standard error of a figure over some frames, from what it is without each of them; 0 of fewer than two.
fn jackknife(frames: usize, without: impl Fn(usize) -> f64) -> f64 {
    if frames < 2 {
        return 0.0;
    }
    #[allow(clippy::cast_precision_loss, reason = "a number of frames")]
    let count = frames as f64;
    let figures: Vec<f64> = (0..frames).map(without).collect();
    let mean = figures.iter().sum::<f64>() / count;
    let squares: f64 = figures.iter().map(|figure| (figure - mean).powi(2)).sum();
    ((count - 1.0) / count * squares).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a mean it is the standard deviation over the root of the number of frames.
    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let values: [f64; 5] = [1.0, 0.5, 1.0, 0.75, 0.25];
        let sum: f64 = values.iter().sum();
        let found = jackknife(5, |left_out| (sum - values[left_out]) / 4.0);
        let squares: f64 = values.iter().map(|value| (value - sum / 5.0).powi(2)).sum();
        assert!((found - (squares / 4.0 / 5.0).sqrt()).abs() < 1e-12, "{found}");
        assert_eq!(jackknife(4, |_| 0.9), 0.0);
        assert_eq!(jackknife(1, |_| unreachable!("nothing is left")), 0.0);
    }
}
