// SPDX-License-Identifier: MIT OR Apache-2.0
//! Objects that a network detects, and the matching of two lists of them.

use foveate_pixels::Rect;

/// An object that a network detects.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Detection {
    /// The number of the class, from 0.
    pub class: usize,
    /// The confidence of the network, from 0 to 1.
    pub score: f32,
    /// The bounding box in pixels.
    pub rect: Rect,
}

/// Returns the intersection over union of two rectangles.
pub(super) fn intersection_over_union(a: &Rect, b: &Rect) -> f64 {
    let width = a.x1.min(b.x1) - a.x0.max(b.x0);
    let height = a.y1.min(b.y1) - a.y0.max(b.y0);
    if width <= 0.0 || height <= 0.0 {
        return 0.0;
    }
    let intersection = width * height;
    intersection / (a.area() + b.area() - intersection)
}

/// Non-maximum suppression: among detections of one class that overlap by more than `most`, keeps
/// the one with the highest score. Returns the detections in descending order of score.
pub(super) fn suppress_overlapping(mut found: Vec<Detection>, most: f64) -> Vec<Detection> {
    found.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: Vec<Detection> = Vec::new();
    for detection in found {
        let is_same = |other: &Detection| {
            other.class == detection.class
                && intersection_over_union(&other.rect, &detection.rect) > most
        };
        if !kept.iter().any(is_same) {
            kept.push(detection);
        }
    }
    kept
}

/// Matches every detection of `found`, in their order, with the object of `right` that it overlaps
/// most. The order should be that of descending scores. A pair must overlap by at least `least`,
/// and an object is matched at most once. `same` tells which pairs may match. Returns the index of
/// the object for every detection; `None` without a match.
#[must_use]
pub fn match_detections<T>(
    found: &[Detection],
    right: &[T],
    least: f64,
    rect: impl Fn(&T) -> &Rect,
    same: impl Fn(&Detection, &T) -> bool,
) -> Vec<Option<usize>> {
    let mut is_matched = vec![false; right.len()];
    let match_one = |detection: &Detection| {
        let candidates = right
            .iter()
            .enumerate()
            .filter(|(at, other)| !is_matched[*at] && same(detection, other));
        let overlaps = candidates
            .map(|(at, other)| (at, intersection_over_union(&detection.rect, rect(other))));
        let best = overlaps.filter(|(_, found)| *found >= least);
        let best = best.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(at, _)| at);
        if let Some(at) = best {
            is_matched[at] = true;
        }
        best
    };
    found.iter().map(match_one).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn detection(class: usize, score: f32, corners: [f64; 4]) -> Detection {
        Detection { class, score, rect: Rect::from_corners(corners).unwrap() }
    }

    #[test]
    fn the_overlap_is_the_shared_part_of_the_union() {
        let rect = |corners| Rect::from_corners(corners).unwrap();
        let one = rect([0., 0., 4., 4.]);
        for (other, share) in [
            ([0., 0., 4., 4.], 1.0),
            ([2., 0., 6., 4.], 8.0 / 24.0),
            ([4., 0., 8., 4.], 0.0),
            ([5., 5., 6., 6.], 0.0),
            ([1., 1., 1., 3.], 0.0),
        ] {
            assert!(
                (intersection_over_union(&one, &rect(other)) - share).abs() < 1e-12,
                "{other:?}"
            );
        }
    }

    #[test]
    fn of_overlapping_detections_the_one_with_the_highest_score_is_kept() {
        let found = vec![
            detection(0, 0.5, [0., 0., 10., 10.]),
            detection(0, 0.9, [1., 0., 11., 10.]),
            detection(1, 0.4, [0., 0., 10., 10.]),
            detection(0, 0.3, [20., 0., 30., 10.]),
        ];
        let scores: Vec<f32> =
            suppress_overlapping(found, 0.5).iter().map(|one| one.score).collect();
        assert_eq!(scores, [0.9, 0.4, 0.3]);
    }

    #[test]
    fn an_object_is_matched_once_with_the_first_detection_that_fits() {
        let right = [detection(0, 0.9, [0., 0., 10., 10.]), detection(0, 0.9, [4., 0., 14., 10.])];
        let found = [
            detection(0, 0.8, [1., 0., 11., 10.]),
            detection(0, 0.7, [0., 0., 10., 10.]),
            detection(1, 0.6, [4., 0., 14., 10.]),
        ];
        let same = |one: &Detection, other: &Detection| one.class == other.class;
        assert_eq!(
            match_detections(&found, &right, 0.4, |o| &o.rect, same),
            [Some(0), Some(1), None]
        );
        assert_eq!(match_detections(&found, &right, 0.5, |o| &o.rect, same), [Some(0), None, None]);
    }
}
