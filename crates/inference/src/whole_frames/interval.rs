// SPDX-License-Identifier: MIT OR Apache-2.0
//! Wilson's score interval: an interval for a share among all things, computed from the share among
//! a few of them.
//!
//! E. B. Wilson, Probable Inference, the Law of Succession, and Statistical Inference, Journal of
//! the American Statistical Association 22 (1927), pages 209 to 212. It assumes that the things are
//! independent.

use foveate_network::{
    Network,
    vision::{AgreementSums, DetectionCounts},
};
use serde::Serialize;

/// The number of standard deviations from the mean within which 95 % of the values of a normal
/// variable lie.
const NORMAL_QUANTILE: f64 = 1.959_963_984_540_054;
/// The width above which the user is told that an interval is wide because there are few things.
const WIDE_INTERVAL: f64 = 0.02;

/// Intervals that hold the shares of all such things with 95 % confidence, if the things are
/// independent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ConfidenceIntervals {
    /// The interval of the agreement; `None` if the agreement is an error or a class at every
    /// position, or if nothing was found.
    pub agreement: Option<[f64; 2]>,
    /// The interval of the share of detections that are kept, if there are any.
    pub kept: Option<[f64; 2]>,
    /// The interval of the share of detections that are right, if there are any.
    pub right: Option<[f64; 2]>,
}

impl ConfidenceIntervals {
    /// Returns the intervals of sums over frames. Positions of a frame have no interval: neighbors
    /// are so alike that their number says nothing about other frames.
    pub(super) fn from_sums(sums: &AgreementSums) -> Self {
        let counted = if sums.position_share().is_some() { None } else { sums.agreement_count() };
        Self::new(sums.agreement(), sums.total_counts(), counted)
    }

    /// Returns the intervals of an agreement over the detections in `found`, or over `counted`
    /// other things if no detections were read.
    #[must_use]
    pub fn new(agreement: f64, found: Option<DetectionCounts>, counted: Option<u64>) -> Self {
        let interval = |share, count| {
            (count > 0).then(|| wilson_interval(share, count_to_f64(count), NORMAL_QUANTILE))
        };
        let Some(found) = found else {
            let agreement = counted.and_then(|count| interval(agreement, count));
            return Self { agreement, ..Self::default() };
        };
        let kept = interval(found.kept_share(), found.whole);
        let right = interval(found.precision(), found.seen);
        // The agreement has the interval of the smaller share.
        let is_kept = found.kept_share() <= found.precision();
        Self { agreement: if is_kept { kept.or(right) } else { right.or(kept) }, kept, right }
    }

    /// Returns the interval of the agreement, if it is wide because there are few things.
    #[must_use]
    pub fn wide_agreement(&self) -> Option<[f64; 2]> {
        self.agreement.filter(|[low, high]| high - low > WIDE_INTERVAL)
    }
}

/// Returns whether a network has an output with a class at every position.
#[must_use]
pub fn has_class_map(network: &Network) -> bool {
    let is_map = |shape: &[usize]| matches!(*shape, [1, classes, height, width] if classes > 1 && height * width > 1);
    network.outputs().iter().any(|&value| is_map(network.form(value).shape()))
}

/// Returns Wilson's score interval of a share of `count` things, which is above 0, that reaches
/// `deviations` standard deviations to both sides.
#[must_use]
pub fn wilson_interval(share: f64, count: f64, deviations: f64) -> [f64; 2] {
    let square = deviations.powi(2) / count;
    let spread = deviations * (share * (1.0 - share) / count + square / (4.0 * count)).sqrt();
    [-spread, spread].map(|way| ((share + square / 2.0 + way) / (1.0 + square)).clamp(0.0, 1.0))
}

#[allow(clippy::cast_precision_loss, reason = "a number of things")]
fn count_to_f64(count: u64) -> f64 {
    count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ends are those that
    /// `scipy.stats.binomtest(kept, count).proportion_ci(0.95, method="wilson")` of `SciPy` prints.
    #[test]
    fn intervals_are_those_of_scipy() {
        for (kept, count, low, high) in [
            (101.0, 107.0, 0.883_030_384_823_427_3, 0.974_049_637_496_375_2),
            (20.0, 20.0, 0.838_874_841_947_180_8, 1.0),
            (0.0, 9.0, 0.0, 0.299_145_048_419_544_04),
            (3.0, 7.0, 0.158_219_855_251_470_2, 0.749_541_635_472_342_8),
            (480.0, 488.0, 0.967_988_534_009_925_2, 0.991_670_298_191_270_8),
        ] {
            let found = wilson_interval(kept / count, count, NORMAL_QUANTILE);
            assert!((found[0] - low).abs() < 1e-12, "{kept} of {count}: {found:?}");
            assert!((found[1] - high).abs() < 1e-12, "{kept} of {count}: {found:?}");
        }
    }

    /// Both ends are shares that a test at this confidence just cannot distinguish from the
    /// observed share.
    #[test]
    fn ends_are_as_far_away_as_the_confidence_says() {
        for (share, count) in [(0.94, 107.0), (0.5, 7.0), (0.02, 300.0)] {
            for end in wilson_interval(share, count, NORMAL_QUANTILE) {
                let away = (share - end).abs() / (end * (1.0 - end) / count).sqrt();
                assert!((away - NORMAL_QUANTILE).abs() < 1e-9, "{share} of {count}: {end}");
            }
        }
        assert!(
            wilson_interval(1.0, 20.0, NORMAL_QUANTILE)[1] == 1.0
                && wilson_interval(0.0, 20.0, NORMAL_QUANTILE)[0] == 0.0
        );
    }

    #[test]
    fn the_agreement_has_the_interval_of_the_smaller_share() {
        let found = |whole, kept, seen, added| Some(DetectionCounts { whole, kept, seen, added });
        let few = ConfidenceIntervals::new(0.9, found(100, 98, 100, 10), Some(100));
        assert!(
            few.agreement == few.right && few.kept != few.right && few.wide_agreement().is_some()
        );
        let none = ConfidenceIntervals::new(1.0, found(0, 0, 0, 0), Some(0));
        assert_eq!((none, none.wide_agreement()), (ConfidenceIntervals::default(), None));
        // Nothing of the whole frames is found, but much else is.
        let only = ConfidenceIntervals::new(0.0, found(0, 0, 9, 9), Some(0));
        assert_eq!((only.kept, only.agreement), (None, only.right));
        let many = ConfidenceIntervals::new(0.99, None, Some(60_000));
        assert!(many.agreement.is_some() && many.wide_agreement().is_none());
        assert_eq!(ConfidenceIntervals::new(0.9, None, None), ConfidenceIntervals::default());
    }
}
