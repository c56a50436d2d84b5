// SPDX-License-Identifier: MIT OR Apache-2.0
//! The classes of objects: by size, with the limits of COCO, by speed, and by contrast.

use foveate_pixels::Rect;

/// The group and name of every class. The first class holds every object.
pub(super) const CLASSES: [(&str, &str); 13] = [
    (ALL, "all"),
    ("size", "small"),
    ("size", "medium"),
    ("size", "large"),
    ("speed", "still"),
    ("speed", "slow"),
    ("speed", "medium"),
    ("speed", "fast"),
    ("speed", UNKNOWN),
    ("contrast", "low"),
    ("contrast", "medium"),
    ("contrast", "high"),
    ("contrast", UNKNOWN),
];
/// The group of the class that holds every object.
pub(super) const ALL: &str = "all";
/// The class of the objects whose speed or contrast is unknown.
pub(super) const UNKNOWN: &str = "unknown";

/// The least areas of medium and large objects, in pixels of the frame that the camera sees.
const AREAS: [f64; 2] = [32.0 * 32.0, 96.0 * 96.0];
/// The least speeds of slow, medium and fast objects, in pixels per frame.
const SPEEDS: [f64; 3] = [0.5, 2.0, 8.0];
/// The least contrasts of medium and high contrast, in grey levels of 8 bits.
const CONTRASTS: [f64; 2] = [8.0, 32.0];

/// Returns the classes of an object, as indices into [`CLASSES`]. An unknown speed or contrast has
/// its own class.
pub(super) fn classes_of(rect: &Rect, speed: Option<f64>, contrast: Option<f64>) -> [usize; 4] {
    let size = 1 + reached_limits(rect.area(), &AREAS);
    let speed = 4 + speed.map_or(SPEEDS.len() + 1, |speed| reached_limits(speed, &SPEEDS));
    let contrast =
        9 + contrast.map_or(CONTRASTS.len() + 1, |value| reached_limits(value, &CONTRASTS));
    [0, size, speed, contrast]
}

/// Counts the limits that a value reaches.
fn reached_limits(value: f64, limits: &[f64]) -> usize {
    limits.iter().filter(|limit| value >= **limit).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_are_in_one_class_of_every_group() {
        let names = |side: f64, speed, contrast| {
            let rect = Rect::from_corners([0.0, 0.0, side, side]).unwrap();
            classes_of(&rect, speed, contrast).map(|class| CLASSES[class])
        };
        let of = |size, speed, contrast| {
            [(ALL, "all"), ("size", size), ("speed", speed), ("contrast", contrast)]
        };
        assert_eq!(names(31.9, Some(0.49), Some(7.9)), of("small", "still", "low"));
        assert_eq!(names(32.0, Some(0.5), Some(8.0)), of("medium", "slow", "medium"));
        assert_eq!(names(95.9, Some(2.0), Some(32.0)), of("medium", "medium", "high"));
        assert_eq!(names(96.0, Some(8.0), None), of("large", "fast", "unknown"));
        assert_eq!(names(96.0, None, None), of("large", "unknown", "unknown"));
    }
}
