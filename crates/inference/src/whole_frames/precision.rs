// SPDX-License-Identifier: MIT OR Apache-2.0
//! Average precision against ground truth.

use foveate_network::vision::{Detection, match_detections};
use foveate_pixels::Rect;

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
}
