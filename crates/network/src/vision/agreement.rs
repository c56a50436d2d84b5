// SPDX-License-Identifier: MIT OR Apache-2.0
//! The agreement between the outputs of a network for the screen and those for the input frames.

use super::detection::{Detection, match_detections};
use super::detector::Detector;
use super::distance::{OutputDistance, index_of_largest};
use super::frame_findings::FrameFindings;
use serde::Serialize;

/// The smallest overlap, as intersection over union, of detections that are the same object.
pub const SAME_OBJECT_OVERLAP: f64 = 0.5;
/// The areas in pixels of the frame from which objects are medium and large, as in COCO.
const SIZE_AREAS: [f64; 2] = [32.0 * 32.0, 96.0 * 96.0];

/// Sums of the agreement over frames.
#[derive(Clone, Debug, Default)]
pub struct AgreementSums {
    /// The number of frames.
    pub frames: u64,
    /// The distance of the outputs from those for the input frames.
    pub distance: OutputDistance,
    classes: ClassSums,
    /// The number of positions at which an output has a class, and the number of those at which the
    /// class is the same.
    position_classes: (u64, u64),
    detection_counts: Option<[DetectionCounts; 3]>,
}

/// Sums over the frames for which an output is one class.
#[derive(Clone, Copy, Debug, Default)]
struct ClassSums {
    frames: u64,
    same: u64,
    whole_margin: f64,
    seen_margin: f64,
}

/// Counts of detections, for example of those of one size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct DetectionCounts {
    /// Detections in input frames.
    pub whole: u64,
    /// Detections in input frames that are found on the screen, too.
    pub kept: u64,
    /// Detections on the screen.
    pub seen: u64,
    /// Detections on the screen that match no detection in the input frames.
    pub added: u64,
}

/// The agreement of detections on the screen with those in the input frames.
#[derive(Clone, Debug, Serialize)]
pub struct DetectionAgreement {
    /// The detector, as it is written on the command line.
    pub detector: String,
    /// The detections of all sizes.
    pub all: DetectionCounts,
    /// The detections with an area below 32x32 pixels.
    pub small: DetectionCounts,
    /// The detections with an area from 32x32 to below 96x96 pixels.
    pub medium: DetectionCounts,
    /// The detections with an area of 96x96 pixels or more.
    pub large: DetectionCounts,
    /// The share of the detections in input frames that are kept.
    pub kept_share: f64,
    /// The share of the detections on the screen that are in the input frames, too.
    pub precision: f64,
}

/// The agreement of outputs that are one class per frame.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ClassAgreement {
    /// The share of outputs with the same largest value, over all frames and all outputs that are
    /// one class.
    pub same_share: f64,
    /// The mean difference between the largest and the second largest value, for input frames.
    pub whole_margin: f64,
    /// The mean difference, for the screen, between the value of the input frame's class and the
    /// largest value of any other class. It is negative where the screen has another class.
    pub seen_margin: f64,
}

impl DetectionCounts {
    fn add(&mut self, other: Self) {
        self.whole += other.whole;
        self.kept += other.kept;
        self.seen += other.seen;
        self.added += other.added;
    }

    /// The share of the detections in input frames that are kept; 1 if there are none.
    #[must_use]
    pub fn kept_share(&self) -> f64 {
        share(self.kept, self.whole)
    }

    /// The share of the detections on the screen that are in the input frames, too; 1 if there are
    /// none.
    #[must_use]
    pub fn precision(&self) -> f64 {
        share(self.seen - self.added, self.seen)
    }
}

#[allow(clippy::cast_precision_loss, reason = "a share")]
fn share(part: u64, all: u64) -> f64 {
    if all == 0 { 1.0 } else { part as f64 / all as f64 }
}

/// The detections of a frame that count, matched between the input frame and the screen.
#[derive(Clone, Debug, Default)]
pub struct DetectionPairs {
    /// The detections in the input frame, each with true if it is on the screen, too.
    pub whole: Vec<(Detection, bool)>,
    /// The detections on the screen, each with true if it is in the input frame, too.
    pub seen: Vec<(Detection, bool)>,
}

impl DetectionPairs {
    /// Matches the detections that count by their scores and heights. Only detections of the same
    /// class can match.
    #[must_use]
    pub fn from_detections(detector: &Detector, whole: &[Detection], seen: &[Detection]) -> Self {
        let accepted = |all: &[Detection]| -> Vec<Detection> {
            all.iter().filter(|detection| detector.accepts(detection)).cloned().collect()
        };
        let (whole, seen) = (accepted(whole), accepted(seen));
        let same = |detection: &Detection, other: &Detection| detection.class == other.class;
        let matches =
            match_detections(&seen, &whole, SAME_OBJECT_OVERLAP, |detection| &detection.rect, same);
        let mut kept = vec![false; whole.len()];
        matches.iter().flatten().for_each(|&at| kept[at] = true);
        Self {
            whole: whole.into_iter().zip(kept).collect(),
            seen: seen.into_iter().zip(matches.iter().map(Option::is_some)).collect(),
        }
    }

    fn counts_by_size(&self) -> [DetectionCounts; 3] {
        let mut sizes = [DetectionCounts::default(); 3];
        let size = |detection: &Detection| {
            SIZE_AREAS.iter().filter(|&&area| detection.rect.area() >= area).count()
        };
        for (detection, kept) in &self.whole {
            sizes[size(detection)].add(DetectionCounts {
                whole: 1,
                kept: (*kept).into(),
                ..DetectionCounts::default()
            });
        }
        for (detection, matched) in &self.seen {
            sizes[size(detection)].add(DetectionCounts {
                seen: 1,
                added: (!matched).into(),
                ..DetectionCounts::default()
            });
        }
        sizes
    }

    /// Returns the counts of all sizes together.
    #[must_use]
    pub fn total_counts(&self) -> DetectionCounts {
        let mut all = DetectionCounts::default();
        self.counts_by_size().into_iter().for_each(|found| all.add(found));
        all
    }
}

impl AgreementSums {
    /// Returns the sums for one frame.
    #[must_use]
    pub fn from_frame(
        whole: &FrameFindings,
        seen: &FrameFindings,
        pairs: Option<&DetectionPairs>,
    ) -> Self {
        let mut sums = Self { frames: 1, ..Self::default() };
        for (whole_output, seen_output) in whole.outputs.iter().zip(&seen.outputs) {
            sums.distance.add(OutputDistance::between(&whole_output.values, &seen_output.values).0);
            match whole_output.shape[..] {
                // Detections have classes in their boxes.
                _ if pairs.is_some() => {}
                [1, classes] | [1, classes, 1, 1] if classes > 1 => {
                    sums.classes.add(&whole_output.values, &seen_output.values);
                }
                [1, classes, height, width] if classes > 1 => {
                    let positions = height * width;
                    let same =
                        count_same_positions(&whole_output.values, &seen_output.values, positions);
                    sums.position_classes.0 += positions as u64;
                    sums.position_classes.1 += same;
                }
                _ => {}
            }
        }
        sums.detection_counts = pairs.map(DetectionPairs::counts_by_size);
        sums
    }

    /// Adds the sums of other frames.
    pub fn add(&mut self, other: &Self) {
        self.frames += other.frames;
        self.distance.add(other.distance);
        self.classes.frames += other.classes.frames;
        self.classes.same += other.classes.same;
        self.classes.whole_margin += other.classes.whole_margin;
        self.classes.seen_margin += other.classes.seen_margin;
        self.position_classes.0 += other.position_classes.0;
        self.position_classes.1 += other.position_classes.1;
        if let Some(found) = other.detection_counts {
            let sums = self.detection_counts.get_or_insert_default();
            sums.iter_mut().zip(found).for_each(|(sum, found)| sum.add(found));
        }
    }

    /// The share of positions with the same class, if an output has a class per position.
    #[must_use]
    pub fn position_share(&self) -> Option<f64> {
        (self.position_classes.0 > 0)
            .then(|| share(self.position_classes.1, self.position_classes.0))
    }

    /// The agreement of classes, if an output is one class per frame.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "means")]
    pub fn class_agreement(&self) -> Option<ClassAgreement> {
        let ClassSums { frames, same, whole_margin, seen_margin } = self.classes;
        (frames > 0).then(|| ClassAgreement {
            same_share: share(same, frames),
            whole_margin: whole_margin / frames as f64,
            seen_margin: seen_margin / frames as f64,
        })
    }

    /// The counts of detections of all sizes, if detections are read.
    #[must_use]
    pub fn total_counts(&self) -> Option<DetectionCounts> {
        self.detection_counts.map(|sizes| {
            let mut all = DetectionCounts::default();
            sizes.into_iter().for_each(|found| all.add(found));
            all
        })
    }

    /// The agreement of detections by size, if detections are read. `detector` is the one that
    /// reads them.
    #[must_use]
    pub fn detection_agreement(&self, detector: &Detector) -> Option<DetectionAgreement> {
        let (all, [small, medium, large]) = (self.total_counts()?, self.detection_counts?);
        let (kept_share, precision) = (all.kept_share(), all.precision());
        let detector = detector.to_string();
        Some(DetectionAgreement { detector, all, small, medium, large, kept_share, precision })
    }

    /// The agreement as one number from 0 to 1. For detections it is the smaller of the share that
    /// is kept and the precision. For classes it is the share of frames, or of positions, with the
    /// same class, and the smaller one if a network has both kinds of outputs. For other outputs it
    /// is 1 less the relative RMS error, at least 0.
    #[must_use]
    pub fn agreement(&self) -> f64 {
        if let Some(found) = self.total_counts() {
            return found.kept_share().min(found.precision());
        }
        let classes = self.class_agreement().map(|classes| classes.same_share);
        let both = [classes, self.position_share()].into_iter().flatten().reduce(f64::min);
        both.unwrap_or_else(|| {
            let left = 1.0 - self.distance.relative_rms();
            // The comparison is false for NaN, which agrees with nothing.
            if left > 0.0 { left } else { 0.0 }
        })
    }

    /// The number of detections, frames or positions that can agree, or `None` if the agreement is
    /// an error.
    #[must_use]
    pub fn agreement_count(&self) -> Option<u64> {
        if let Some(found) = self.total_counts() {
            return Some(found.whole.min(found.seen));
        }
        let frames = (self.classes.frames > 0).then_some(self.classes.frames);
        frames.or_else(|| (self.position_classes.0 > 0).then_some(self.position_classes.0))
    }
}

impl ClassSums {
    fn add(&mut self, whole: &[f32], seen: &[f32]) {
        let class = index_of_largest(whole);
        let margin = |values: &[f32]| {
            let others = values.iter().enumerate().filter(|(at, _)| *at != class);
            let other = others.map(|(_, value)| *value).fold(f32::NEG_INFINITY, f32::max);
            f64::from(values[class]) - f64::from(other)
        };
        self.frames += 1;
        self.same += u64::from(index_of_largest(seen) == class);
        self.whole_margin += margin(whole);
        self.seen_margin += margin(seen);
    }
}

/// Returns the number of positions at which the same channel is the largest.
fn count_same_positions(whole: &[f32], seen: &[f32], positions: usize) -> u64 {
    let class = |values: &[f32], position: usize| {
        let channels: Vec<f32> = values.iter().skip(position).step_by(positions).copied().collect();
        index_of_largest(&channels)
    };
    (0..positions).filter(|&position| class(whole, position) == class(seen, position)).count()
        as u64
}

#[cfg(test)]
mod tests {
    use super::super::detection::tests::detection;
    use super::super::detection_format::{DetectionFormat, OutputTensor};
    use super::*;

    fn findings(shape: &[usize], values: &[f32]) -> FrameFindings {
        let (name, shape, values) = ("out".to_owned(), shape.to_vec(), values.to_vec());
        FrameFindings { outputs: vec![OutputTensor { name, shape, values }], detections: None }
    }

    #[test]
    fn classes_agree_by_frames_and_by_positions() {
        let whole = findings(&[1, 3], &[1.0, 5.0, 2.0]);
        let mut sums =
            AgreementSums::from_frame(&whole, &findings(&[1, 3], &[1.0, 4.0, 3.0]), None);
        let classes = sums.class_agreement().unwrap();
        assert_eq!((classes.same_share, classes.whole_margin, classes.seen_margin), (1., 3., 1.));
        sums.add(&AgreementSums::from_frame(&whole, &findings(&[1, 3], &[9.0, 4.0, 3.0]), None));
        assert_eq!((sums.class_agreement().unwrap().same_share, sums.agreement()), (0.5, 0.5));
        assert_eq!(sums.class_agreement().unwrap().seen_margin, -2.0);
        // There are two classes at three positions, and the last position differs.
        let whole = findings(&[1, 2, 1, 3], &[0., 1., 0., 1., 0., 1.]);
        let seen = findings(&[1, 2, 1, 3], &[0., 1., 2., 1., 0., 1.]);
        let sums = AgreementSums::from_frame(&whole, &seen, None);
        assert_eq!((sums.position_share(), sums.agreement()), (Some(2.0 / 3.0), 2.0 / 3.0));
        assert!(sums.class_agreement().is_none());
    }

    #[test]
    fn numbers_agree_by_their_error() {
        let whole = findings(&[1, 1, 1, 2], &[3.0, 4.0]);
        let at = |values| {
            AgreementSums::from_frame(&whole, &findings(&[1, 1, 1, 2], values), None).agreement()
        };
        assert_eq!(at(&[3.0, 4.0]), 1.0);
        assert!((at(&[3.0, 3.0]) - 0.8).abs() < 1e-12);
        assert_eq!(at(&[-9.0, 99.0]), 0.0);
        assert_eq!(at(&[f32::NAN, 4.0]), 0.0);
    }

    #[test]
    fn detections_are_kept_lost_or_added_by_size() {
        let detector = Detector::new(DetectionFormat::Yolox);
        let whole = [
            detection(0, 0.9, [0., 0., 20., 20.]),
            detection(0, 0.8, [100., 0., 150., 50.]),
            detection(0, 0.2, [300., 0., 350., 50.]),
        ];
        let seen = [
            detection(0, 0.7, [1., 0., 21., 20.]),
            detection(1, 0.7, [100., 0., 150., 50.]),
            detection(0, 0.9, [200., 0., 400., 200.]),
        ];
        let pairs = DetectionPairs::from_detections(&detector, &whole, &seen);
        let none = findings(&[1, 1], &[0.0]);
        let sums = AgreementSums::from_frame(&none, &none, Some(&pairs));
        let kept = sums.detection_agreement(&detector).unwrap();
        assert_eq!(kept.all, DetectionCounts { whole: 2, kept: 1, seen: 3, added: 2 });
        assert_eq!(kept.small, DetectionCounts { whole: 1, kept: 1, seen: 1, added: 0 });
        assert_eq!(kept.medium, DetectionCounts { whole: 1, kept: 0, seen: 1, added: 1 });
        assert_eq!(kept.large, DetectionCounts { whole: 0, kept: 0, seen: 1, added: 1 });
        assert_eq!((kept.kept_share, kept.precision, sums.agreement()), (0.5, 1. / 3., 1. / 3.));
        assert_eq!(DetectionCounts::default().kept_share(), 1.0);
    }
}
