// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether a network says the same of what the receiver sees as of whole frames.

use super::detection::{Detection, matched};
use super::detector::Detector;
use super::distance::{Distance, largest};
use super::findings::Findings;
use serde::Serialize;

/// Detections are the same object if they overlap by at least this share.
pub const SAME_OBJECT: f64 = 0.5;
/// Areas in pixels of the frame at which objects become medium and large, as of COCO.
const AREAS: [f64; 2] = [32.0 * 32.0, 96.0 * 96.0];

/// Sums over frames.
#[derive(Clone, Debug, Default)]
pub struct Sums {
    /// Frames.
    pub frames: u64,
    /// How far the outputs are from those of whole frames.
    pub distance: Distance,
    classes: ClassSums,
    /// Places of outputs that have a class each, and those with the same.
    places: (u64, u64),
    detections: Option<[Found; 3]>,
}

/// Over frames with outputs that are one class.
#[derive(Clone, Copy, Debug, Default)]
struct ClassSums {
    frames: u64,
    same: u64,
    whole_margin: f64,
    seen_margin: f64,
}

/// Detections of one size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Found {
    /// Found in whole frames.
    pub whole: u64,
    /// Of these found in what the receiver sees, too.
    pub kept: u64,
    /// Found in what the receiver sees.
    pub seen: u64,
    /// Of these found in nothing that the whole frames have.
    pub added: u64,
}

/// Detections in what the receiver sees beside those in whole frames.
#[derive(Clone, Debug, Serialize)]
pub struct DetectionsKept {
    /// How they are read, as on the command line.
    pub detector: String,
    /// All sizes.
    pub all: Found,
    /// Below 32x32 pixels.
    pub small: Found,
    /// Up to 96x96 pixels.
    pub medium: Found,
    /// Larger ones.
    pub large: Found,
    /// Share of the detections in whole frames that are kept.
    pub kept_share: f64,
    /// Share of the detections in what the receiver sees that are in whole frames, too.
    pub precision: f64,
}

/// The class of a frame.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ClassKept {
    /// Share of the frames with the same largest value in every output that is one class.
    pub same_share: f64,
    /// Largest value less the second largest, in whole frames: the mean.
    pub whole_margin: f64,
    /// The same class's value less the largest other one, in what the receiver sees: the mean. Negative where the class is another one.
    pub seen_margin: f64,
}

impl Found {
    fn add(&mut self, other: Self) {
        self.whole += other.whole;
        self.kept += other.kept;
        self.seen += other.seen;
        self.added += other.added;
    }

    /// Share of the whole frames' detections that are kept; all of none.
    #[must_use]
    pub fn kept_share(&self) -> f64 {
        share(self.kept, self.whole)
    }

    /// Share of the receiver's detections that are those of whole frames; all of none.
    #[must_use]
    pub fn precision(&self) -> f64 {
        share(self.seen - self.added, self.seen)
    }
}

#[allow(clippy::cast_precision_loss, reason = "a share")]
fn share(part: u64, all: u64) -> f64 {
    if all == 0 { 1.0 } else { part as f64 / all as f64 }
}

/// The detections of a frame that count, and which of them are the same.
#[derive(Clone, Debug, Default)]
pub struct Pairs {
    /// Those of the whole frame, and whether the receiver sees them, too.
    pub whole: Vec<(Detection, bool)>,
    /// Those in what the receiver sees, and whether the whole frame has them, too.
    pub seen: Vec<(Detection, bool)>,
}

impl Pairs {
    /// The same object has the same class. Both must count by their scores and heights.
    #[must_use]
    pub fn of(detector: &Detector, whole: &[Detection], seen: &[Detection]) -> Self {
        let counting = |all: &[Detection]| -> Vec<Detection> {
            all.iter().filter(|one| detector.counts(one)).cloned().collect()
        };
        let (whole, seen) = (counting(whole), counting(seen));
        let same = |one: &Detection, other: &Detection| one.class == other.class;
        let right = matched(&seen, &whole, SAME_OBJECT, |one| &one.rect, same);
        let mut kept = vec![false; whole.len()];
        right.iter().flatten().for_each(|&at| kept[at] = true);
        Self {
            whole: whole.into_iter().zip(kept).collect(),
            seen: seen.into_iter().zip(right.iter().map(Option::is_some)).collect(),
        }
    }

    fn sizes(&self) -> [Found; 3] {
        let mut sizes = [Found::default(); 3];
        let size = |one: &Detection| AREAS.iter().filter(|&&area| one.rect.area() >= area).count();
        for (one, kept) in &self.whole {
            sizes[size(one)].add(Found { whole: 1, kept: (*kept).into(), ..Found::default() });
        }
        for (one, right) in &self.seen {
            sizes[size(one)].add(Found { seen: 1, added: (!right).into(), ..Found::default() });
        }
        sizes
    }

    /// All sizes together.
    #[must_use]
    pub fn found(&self) -> Found {
        let mut all = Found::default();
        self.sizes().into_iter().for_each(|found| all.add(found));
        all
    }
}

impl Sums {
    /// Of one frame.
    #[must_use]
    pub fn of(whole: &Findings, seen: &Findings, pairs: Option<&Pairs>) -> Self {
        let mut sums = Self { frames: 1, ..Self::default() };
        for (right, found) in whole.outputs.iter().zip(&seen.outputs) {
            sums.distance.add(Distance::of(&right.values, &found.values).0);
            match right.shape[..] {
                // Boxes have classes of their own.
                _ if pairs.is_some() => {}
                [1, classes] | [1, classes, 1, 1] if classes > 1 => {
                    sums.classes.add(&right.values, &found.values);
                }
                [1, classes, height, width] if classes > 1 => {
                    let places = height * width;
                    let same = same_places(&right.values, &found.values, places);
                    sums.places.0 += places as u64;
                    sums.places.1 += same;
                }
                _ => {}
            }
        }
        sums.detections = pairs.map(Pairs::sizes);
        sums
    }

    /// Adds those of other frames.
    pub fn add(&mut self, other: &Self) {
        self.frames += other.frames;
        self.distance.add(other.distance);
        self.classes.frames += other.classes.frames;
        self.classes.same += other.classes.same;
        self.classes.whole_margin += other.classes.whole_margin;
        self.classes.seen_margin += other.classes.seen_margin;
        self.places.0 += other.places.0;
        self.places.1 += other.places.1;
        if let Some(found) = other.detections {
            let sums = self.detections.get_or_insert_default();
            sums.iter_mut().zip(found).for_each(|(sum, found)| sum.add(found));
        }
    }

    /// Share of places with the same class.
    #[must_use]
    pub fn places(&self) -> Option<f64> {
        (self.places.0 > 0).then(|| share(self.places.1, self.places.0))
    }

    /// How often the class is the same, and by how much, if outputs are one.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "means")]
    pub fn classes(&self) -> Option<ClassKept> {
        let ClassSums { frames, same, whole_margin, seen_margin } = self.classes;
        (frames > 0).then(|| ClassKept {
            same_share: share(same, frames),
            whole_margin: whole_margin / frames as f64,
            seen_margin: seen_margin / frames as f64,
        })
    }

    /// All detections.
    #[must_use]
    pub fn found(&self) -> Option<Found> {
        self.detections.map(|sizes| {
            let mut all = Found::default();
            sizes.into_iter().for_each(|found| all.add(found));
            all
        })
    }

    /// Detections by size, if they are read, which `detector` does.
    #[must_use]
    pub fn detections(&self, detector: &Detector) -> Option<DetectionsKept> {
        let (all, [small, medium, large]) = (self.found()?, self.detections?);
        let (kept_share, precision) = (all.kept_share(), all.precision());
        let detector = detector.to_string();
        Some(DetectionsKept { detector, all, small, medium, large, kept_share, precision })
    }

    /// The agreement in one number, 0 to 1. Of detections the smaller of the share that is kept and the share that is right; else the share of
    /// frames, or of places, with the same class; else what the relative RMS error leaves of 1.
    #[must_use]
    pub fn agreement(&self) -> f64 {
        if let Some(found) = self.found() {
            return found.kept_share().min(found.precision());
        }
        let classes = self.classes().map(|classes| classes.same_share);
        let both = [classes, self.places()].into_iter().flatten().reduce(f64::min);
        both.unwrap_or_else(|| {
            let left = 1.0 - self.distance.relative();
            // What is no number agrees with nothing.
            if left > 0.0 { left } else { 0.0 }
        })
    }

    /// How many things agree or do not: detections, frames, places. None where it is an error that counts.
    #[must_use]
    pub fn counted(&self) -> Option<u64> {
        if let Some(found) = self.found() {
            return Some(found.whole.min(found.seen));
        }
        let frames = (self.classes.frames > 0).then_some(self.classes.frames);
        frames.or_else(|| (self.places.0 > 0).then_some(self.places.0))
    }
}

impl ClassSums {
    fn add(&mut self, whole: &[f32], seen: &[f32]) {
        let class = largest(whole);
        let margin = |values: &[f32]| {
            let others = values.iter().enumerate().filter(|(at, _)| *at != class);
            let other = others.map(|(_, value)| *value).fold(f32::NEG_INFINITY, f32::max);
            f64::from(values[class]) - f64::from(other)
        };
        self.frames += 1;
        self.same += u64::from(largest(seen) == class);
        self.whole_margin += margin(whole);
        self.seen_margin += margin(seen);
    }
}

/// Places at which the largest of the channels is the same.
fn same_places(whole: &[f32], seen: &[f32], places: usize) -> u64 {
    let class = |values: &[f32], place: usize| {
        let channels: Vec<f32> = values.iter().skip(place).step_by(places).copied().collect();
        largest(&channels)
    };
    (0..places).filter(|&place| class(whole, place) == class(seen, place)).count() as u64
}

#[cfg(test)]
mod tests {
    use super::super::detection::tests::detection;
    use super::super::head::{Head, Output};
    use super::*;

    fn findings(shape: &[usize], values: &[f32]) -> Findings {
        let (name, shape, values) = ("out".to_owned(), shape.to_vec(), values.to_vec());
        Findings { outputs: vec![Output { name, shape, values }], detections: None }
    }

    #[test]
    fn classes_agree_by_frames_and_by_places() {
        let whole = findings(&[1, 3], &[1.0, 5.0, 2.0]);
        let mut sums = Sums::of(&whole, &findings(&[1, 3], &[1.0, 4.0, 3.0]), None);
        let classes = sums.classes().unwrap();
        assert_eq!((classes.same_share, classes.whole_margin, classes.seen_margin), (1., 3., 1.));
        sums.add(&Sums::of(&whole, &findings(&[1, 3], &[9.0, 4.0, 3.0]), None));
        assert_eq!((sums.classes().unwrap().same_share, sums.agreement()), (0.5, 0.5));
        assert_eq!(sums.classes().unwrap().seen_margin, -2.0);
        // Two classes at three places: the last one differs.
        let whole = findings(&[1, 2, 1, 3], &[0., 1., 0., 1., 0., 1.]);
        let seen = findings(&[1, 2, 1, 3], &[0., 1., 2., 1., 0., 1.]);
        let sums = Sums::of(&whole, &seen, None);
        assert_eq!((sums.places(), sums.agreement()), (Some(2.0 / 3.0), 2.0 / 3.0));
        assert!(sums.classes().is_none());
    }

    #[test]
    fn numbers_agree_by_their_error() {
        let whole = findings(&[1, 1, 1, 2], &[3.0, 4.0]);
        let at = |values| Sums::of(&whole, &findings(&[1, 1, 1, 2], values), None).agreement();
        assert_eq!(at(&[3.0, 4.0]), 1.0);
        assert!((at(&[3.0, 3.0]) - 0.8).abs() < 1e-12);
        assert_eq!(at(&[-9.0, 99.0]), 0.0);
        assert_eq!(at(&[f32::NAN, 4.0]), 0.0);
    }

    #[test]
    fn detections_are_kept_lost_or_added_by_size() {
        let detector = Detector::new(Head::Yolox);
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
        let pairs = Pairs::of(&detector, &whole, &seen);
        let none = findings(&[1, 1], &[0.0]);
        let sums = Sums::of(&none, &none, Some(&pairs));
        let kept = sums.detections(&detector).unwrap();
        assert_eq!(kept.all, Found { whole: 2, kept: 1, seen: 3, added: 2 });
        assert_eq!(kept.small, Found { whole: 1, kept: 1, seen: 1, added: 0 });
        assert_eq!(kept.medium, Found { whole: 1, kept: 0, seen: 1, added: 1 });
        assert_eq!(kept.large, Found { whole: 0, kept: 0, seen: 1, added: 1 });
        assert_eq!((kept.kept_share, kept.precision, sums.agreement()), (0.5, 1. / 3., 1. / 3.));
        assert_eq!(Found::default().kept_share(), 1.0);
    }
}
