// SPDX-License-Identifier: MIT OR Apache-2.0
//! The quality of detections as shares: average precision against ground truth
//! ([`PrecisionCurve`]), and how far shares of few things may be from those of all things
//! ([`ConfidenceIntervals`]).
//!
//! The intervals are Wilson's score intervals ([`wilson_interval`]): E. B. Wilson, Probable
//! Inference, the Law of Succession, and Statistical Inference, Journal of the American
//! Statistical Association 22 (1927), pages 209 to 212. They assume that the things are
//! independent.

use foveate_network::Network;
use foveate_network::vision::{AgreementSums, Detection, DetectionCounts, match_detections};
use foveate_pixels::Rect;
use serde::Serialize;

/// The number of steps of recall from 0 to 1 at which precision is read, as in COCO.
const RECALL_STEPS: u32 = 100;

/// The right and wrong detections of some frames, and the number of objects in them.
#[derive(Clone, Debug, Default)]
pub(crate) struct PrecisionCurve {
    /// The score of every counted detection, and whether the detection is right.
    found: Vec<(f32, bool)>,
    objects: u64,
}

impl PrecisionCurve {
    /// Adds a frame. Objects and detections less than `least` pixels high count neither as found
    /// nor as missed.
    pub(crate) fn add_frame(
        &mut self,
        found: &[Detection],
        objects: &[Rect],
        overlap: f64,
        least: f64,
    ) {
        let counts = |rect: &Rect| rect.height() >= least;
        let right = match_detections(found, objects, overlap, |rect| rect, |_, _| true);
        for (one, right) in found.iter().zip(right) {
            match right {
                Some(at) if counts(&objects[at]) => self.found.push((one.score, true)),
                Some(_) => {}
                None if counts(&one.rect) => self.found.push((one.score, false)),
                None => {}
            }
        }
        self.objects += objects.iter().filter(|rect| counts(rect)).count() as u64;
    }

    /// Returns the number of objects that count.
    pub(crate) fn objects(&self) -> u64 {
        self.objects
    }

    /// Returns the share of the objects that a detection of at least this score finds.
    #[allow(clippy::cast_precision_loss, reason = "a share")]
    pub(crate) fn recall(&self, score: f32) -> f64 {
        let right = self.found.iter().filter(|(own, right)| *right && *own >= score).count();
        if self.objects == 0 { 0.0 } else { right as f64 / self.objects as f64 }
    }

    /// Returns the mean of the precision over recall. The precision at each step is the best that
    /// is reached with this recall or more.
    #[allow(clippy::cast_precision_loss, reason = "shares")]
    pub(crate) fn average_precision(&self) -> f64 {
        if self.objects == 0 {
            return 0.0;
        }
        let mut sorted = self.found.clone();
        sorted.sort_by(|one, other| other.0.total_cmp(&one.0));
        let mut right = 0_u64;
        let points = (1_u64..).zip(&sorted).map(|(all, (_, is_right))| {
            right += u64::from(*is_right);
            (right as f64 / self.objects as f64, right as f64 / all as f64)
        });
        let mut points: Vec<(f64, f64)> = points.collect();
        let mut best = 0.0_f64;
        for (_, precision) in points.iter_mut().rev() {
            best = best.max(*precision);
            *precision = best;
        }
        let at = |recall: f64| points.iter().find(|point| point.0 >= recall).map_or(0.0, |it| it.1);
        let sum: f64 =
            (0..=RECALL_STEPS).map(|step| at(f64::from(step) / f64::from(RECALL_STEPS))).sum();
        sum / f64::from(RECALL_STEPS + 1)
    }
}

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

    fn detection(class: usize, score: f32, corners: [f64; 4]) -> Detection {
        Detection { class, score, rect: rect(corners) }
    }

    fn rect(corners: [f64; 4]) -> Rect {
        Rect::from_corners(corners).unwrap()
    }

    #[test]
    fn precision_is_averaged_over_recall() {
        let objects = [rect([0., 0., 10., 10.]), rect([20., 0., 30., 10.])];
        let mut curve = PrecisionCurve::default();
        // The detections are right, wrong and right: precision is 1 up to half of the objects, then
        // 2 of 3.
        let found = [
            detection(0, 0.9, [0., 0., 10., 10.]),
            detection(0, 0.8, [50., 0., 60., 10.]),
            detection(0, 0.7, [20., 0., 30., 10.]),
        ];
        curve.add_frame(&found, &objects, 0.5, 0.0);
        let expected = (51.0 + 50.0 * 2.0 / 3.0) / 101.0;
        assert!((curve.average_precision() - expected).abs() < 1e-12);
        assert_eq!((curve.recall(0.8), curve.recall(0.0), curve.objects()), (0.5, 1.0, 2));
        // The second frame has as many objects, and nothing is found in it.
        curve.add_frame(&[], &objects, 0.5, 0.0);
        assert_eq!(curve.recall(0.0), 0.5);
        assert!(curve.average_precision() < 0.5);
        assert_eq!(PrecisionCurve::default().average_precision(), 0.0);
    }

    #[test]
    fn what_is_small_counts_neither_way() {
        let objects = [rect([0., 0., 10., 40.]), rect([20., 0., 30., 10.])];
        let found = [
            detection(0, 0.9, [0., 0., 10., 40.]),
            detection(0, 0.8, [20., 0., 30., 10.]),
            detection(0, 0.85, [50., 0., 60., 10.]),
        ];
        let mut curve = PrecisionCurve::default();
        curve.add_frame(&found, &objects, 0.5, 20.0);
        assert_eq!((curve.objects(), curve.average_precision()), (1, 1.0));
        curve.add_frame(&found, &objects, 0.5, 0.0);
        assert!(curve.average_precision() < 1.0);
    }

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
