// SPDX-License-Identifier: MIT OR Apache-2.0
//! Areas of a frame that have a class: rectangles and polygons in pixels, and the map of the
//! regions that follows from them.

use crate::base_classes::BaseClasses;
use crate::{AreaConfig, CameraConfig, ConfigError, MAX_SIDE, RegionClass};

impl AreaConfig {
    /// Adds the ranges of pixels of row `y` that belong to the area.
    fn add_ranges_of_row(&self, y: u32, ranges: &mut Vec<(u32, u32)>) {
        if let Some([left, top, width, height]) = self.rectangle
            && (top..top.saturating_add(height)).contains(&y)
        {
            ranges.push((left, left.saturating_add(width)));
        }
        if let Some(corners) = &self.polygon {
            let mut crossings: Vec<u32> =
                polygon_sides(corners).filter_map(|side| pixels_left_of_side(side, y)).collect();
            crossings.sort_unstable();
            ranges.extend(crossings.chunks_exact(2).map(|pair| (pair[0], pair[1])));
        }
    }
}

fn polygon_sides(corners: &[[u32; 2]]) -> impl Iterator<Item = [[u32; 2]; 2]> {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&from, &to)| [from, to])
}

/// Returns the number of pixels of row `y` whose centers lie on the left of a side, or `None` if
/// the side does not cross the line through these centers.
fn pixels_left_of_side([from, to]: [[u32; 2]; 2], y: u32) -> Option<u32> {
    // Coordinates are doubled, so that centers are whole numbers.
    let [[x1, y1], [x2, y2]] = [from, to].map(|corner| corner.map(|value| 2 * i64::from(value)));
    let center = 2 * i64::from(y) + 1;
    if (y1 > center) == (y2 > center) {
        return None;
    }
    // The side is at `over / below` in this row; the center 2x + 1 of pixel x is on the left of it
    // if x < (over - below) / (2 * below).
    let sign = (y2 - y1).signum();
    let (over, below) = (x1 * (y2 - y1) + (center - y1) * (x2 - x1), y2 - y1);
    let (over, below) = (sign * over, sign * below);
    let count = -(below - over).div_euclid(2 * below);
    Some(u32::try_from(count).unwrap_or(0))
}

/// Checks the areas of a configuration whose frame has `width` x `height` pixels.
pub(crate) fn check_areas(
    config: &CameraConfig,
    areas: &[AreaConfig],
    (width, height): (u32, u32),
) -> Result<(), ConfigError> {
    // Areas of a frame whose size is not known yet must lie within the largest frame.
    let (width, height) =
        if config.frame.has_size() { (width, height) } else { (MAX_SIDE, MAX_SIDE) };
    for (index, area) in areas.iter().enumerate() {
        let key = |name| format!("zones.areas[{index}].{name}");
        let reaches = |x: u64, y: u64| x > width.into() || y > height.into();
        match (&area.rectangle, &area.polygon) {
            (Some(rectangle), None) => {
                let [left, top, across, down] = rectangle.map(u64::from);
                if across == 0 || down == 0 || reaches(left + across, top + down) {
                    let valid = "[left, top, width, height] in pixels, with a width and a height \
                                 of 1 or more";
                    let valid = format!("{valid}, within the frame of {width}x{height} pixels");
                    let value = format!("{rectangle:?}");
                    return Err(ConfigError::Range { key: key("rectangle"), value, valid });
                }
            }
            (None, Some(corners)) => {
                let is_outside = |corner: &&[u32; 2]| reaches(corner[0].into(), corner[1].into());
                let outside = corners.iter().find(is_outside);
                if corners.len() < 3 || outside.is_some() {
                    let valid = "three or more corners [x, y] in pixels";
                    let valid = format!("{valid}, within the frame of {width}x{height} pixels");
                    let value = match outside {
                        Some(corner) => format!("{corner:?} in it"),
                        None => format!("{corners:?}"),
                    };
                    return Err(ConfigError::Range { key: key("polygon"), value, valid });
                }
            }
            (None, None) | (Some(_), Some(_)) => {
                return Err(ConfigError::Type {
                    key: format!("zones.areas[{index}]"),
                    problem:
                        "an area is either a `rectangle` or a `polygon`; give it one of the two"
                            .to_owned(),
                });
            }
        }
    }
    Ok(())
}

/// Returns the classes of the regions of a frame, row by row. Each region has the class that most
/// of its pixels have; pixels outside of all areas have the class of `base`, and the padding does
/// not count. Of classes with equally many pixels, the one that sends more counts: `always`,
/// `keen`, `normal`, `off`.
pub(crate) fn classes_of_areas(
    base: &BaseClasses,
    areas: &[AreaConfig],
    (width, height): (u32, u32),
    side: u32,
) -> Vec<RegionClass> {
    let columns = width.div_ceil(side);
    let mut map = Vec::new();
    let (mut row, mut ranges) = (vec![RegionClass::Normal; width as usize], Vec::new());
    for top in (0..height).step_by(side as usize) {
        let mut counts = vec![[0_u32; RegionClass::ALL.len()]; columns as usize];
        for y in top..(top + side).min(height) {
            base.fill_row(y, side, &mut row);
            for area in areas {
                ranges.clear();
                area.add_ranges_of_row(y, &mut ranges);
                for &(start, end) in &ranges {
                    row[start.min(width) as usize..end.min(width) as usize].fill(area.class);
                }
            }
            for (pixels, counts) in row.chunks(side as usize).zip(&mut counts) {
                for class in pixels {
                    counts[usize::from(class.code())] += 1;
                }
            }
        }
        map.extend(counts.iter().map(most_frequent_class));
    }
    map
}

/// Returns the class with the most pixels, from the numbers of pixels by code.
fn most_frequent_class(counts: &[u32; RegionClass::ALL.len()]) -> RegionClass {
    use RegionClass::{Always, Keen, Normal, Off};
    // The last one of several maxima is returned.
    let in_order = [Off, Normal, Keen, Always].into_iter();
    in_order.max_by_key(|class| counts[usize::from(class.code())]).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(class: RegionClass, corners: &[[u32; 2]]) -> AreaConfig {
        AreaConfig { class, rectangle: None, polygon: Some(corners.to_vec()) }
    }

    fn rectangle(class: RegionClass, rectangle: [u32; 4]) -> AreaConfig {
        AreaConfig { class, rectangle: Some(rectangle), polygon: None }
    }

    fn codes(areas: &[AreaConfig], size: (u32, u32), side: u32) -> Vec<u8> {
        let base = BaseClasses::Normal;
        classes_of_areas(&base, areas, size, side).into_iter().map(RegionClass::code).collect()
    }

    #[test]
    fn later_areas_overrule_earlier_ones() {
        use RegionClass::{Keen, Normal, Off};
        let areas = [
            rectangle(Off, [0, 0, 6, 4]),
            rectangle(Keen, [2, 0, 2, 4]),
            rectangle(Normal, [0, 2, 2, 2]),
        ];
        #[rustfmt::skip]
        assert_eq!(codes(&areas, (8, 4), 2), [
            1, 2, 1, 0,
            0, 2, 1, 0,
        ]);
    }

    #[test]
    fn the_most_frequent_class_counts_and_the_padding_does_not() {
        use RegionClass::{Always, Keen, Off};
        // Regions of 4x4 pixels in a frame of 6x4: the second one has 2x4 pixels.
        assert_eq!(codes(&[rectangle(Off, [0, 0, 6, 2])], (6, 4), 4), [0, 0]);
        assert_eq!(codes(&[rectangle(Off, [0, 0, 5, 3])], (6, 4), 4), [1, 0]);
        assert_eq!(codes(&[rectangle(Off, [0, 0, 6, 3])], (6, 4), 4), [1, 1]);
        let halves = [rectangle(Always, [0, 0, 4, 2]), rectangle(Keen, [0, 2, 4, 2])];
        assert_eq!(codes(&halves, (4, 4), 4), [3]);
    }

    /// The side from (0, 0) to (4, 4) goes through the centers of four pixels.
    #[test]
    fn a_center_on_a_side_belongs_to_what_is_on_its_right() {
        let keen = |corners: &[[u32; 2]]| codes(&[area(RegionClass::Keen, corners)], (4, 4), 1);
        let right = keen(&[[0, 0], [4, 4], [4, 0]]);
        let left = keen(&[[0, 0], [4, 4], [0, 4]]);
        assert_eq!(right, [2, 2, 2, 2, 0, 2, 2, 2, 0, 0, 2, 2, 0, 0, 0, 2]);
        assert!(left.iter().zip(&right).all(|(left, right)| left + right == 2));
    }

    /// Every pixel of random polygons against the definition, in floating point.
    #[test]
    fn polygons_have_the_pixels_of_their_definition() {
        let mut state = 7_u64;
        let mut below = |end: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            u32::try_from((state >> 33) % u64::from(end)).unwrap()
        };
        let mut inside = 0;
        for _ in 0..300 {
            let corners: Vec<[u32; 2]> =
                (0..3 + below(4)).map(|_| [below(21), below(17)]).collect();
            let found = codes(&[area(RegionClass::Keen, &corners)], (20, 16), 1);
            for (place, found) in (0..).zip(found) {
                let (x, y) = (f64::from(place % 20) + 0.5, f64::from(place / 20) + 0.5);
                let is_crossed = |[from, to]: &[[u32; 2]; 2]| {
                    let [[x1, y1], [x2, y2]] = [from, to].map(|corner| corner.map(f64::from));
                    (y1 > y) != (y2 > y) && x1 + (y - y1) * (x2 - x1) / (y2 - y1) > x + 1e-9
                };
                let crossed = polygon_sides(&corners).filter(is_crossed).count();
                assert_eq!(found == 2, crossed % 2 == 1, "{corners:?} at {x}, {y}");
                inside += u32::from(found == 2);
            }
        }
        assert!(inside > 5000, "{inside}");
    }

    #[test]
    fn areas_that_do_not_fit_are_refused() {
        let both = AreaConfig { rectangle: Some([0, 0, 1, 1]), ..area(RegionClass::Off, &[]) };
        let neither = AreaConfig { polygon: None, ..area(RegionClass::Off, &[]) };
        let cases = [
            (both, "one of the two"),
            (neither, "one of the two"),
            (rectangle(RegionClass::Off, [0, 0, 0, 4]), "zones.areas[0].rectangle` = [0, 0, 0, 4]"),
            (rectangle(RegionClass::Off, [10, 0, 7, 4]), "within the frame of 16x8 pixels"),
            (area(RegionClass::Off, &[[0, 0], [4, 4]]), "three or more corners"),
            (area(RegionClass::Off, &[[0, 0], [4, 4], [3, 9]]), "[3, 9] in it"),
        ];
        for (area, words) in cases {
            let mut config = CameraConfig::default();
            (config.frame.width, config.frame.height) = (Some(16), Some(8));
            config.zones = Some(crate::ZonesConfig { areas: vec![area], ..Default::default() });
            let error = config.validate().unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
