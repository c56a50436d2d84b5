// SPDX-License-Identifier: MIT OR Apache-2.0
//! Groups of active regions that touch, also at corners, as boxes of pixels, so that they can be
//! used as detections.

use foveate_camera::Camera;

/// Returns the box around each group of active regions: its left and upper edge, and its right and
/// lower edge, where the box has ended. Boxes end at the edge of the frame, and are in the order of
/// the first region of their groups. `active` has one value for each region.
#[must_use]
pub fn active_groups(camera: &Camera, active: &[bool]) -> Vec<[u32; 4]> {
    let (columns, rows) = (camera.columns(), camera.rows());
    let mut rest = active.to_vec();
    let mut found = Vec::new();
    for first in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
        let index = |(column, row): (u32, u32)| (row * columns + column) as usize;
        if !std::mem::take(&mut rest[index(first)]) {
            continue;
        }
        let ([mut left, mut right], [mut top, mut bottom]) = ([first.0; 2], [first.1; 2]);
        let mut waiting = vec![first];
        while let Some((column, row)) = waiting.pop() {
            (left, right) = (left.min(column), right.max(column));
            (top, bottom) = (top.min(row), bottom.max(row));
            let near = |place: u32, size: u32| place.saturating_sub(1)..(place + 2).min(size);
            for y in near(row, rows) {
                for x in near(column, columns) {
                    if std::mem::take(&mut rest[index((x, y))]) {
                        waiting.push((x, y));
                    }
                }
            }
        }
        let side = camera.region_size();
        let end = |place: u32, size: u32| ((place + 1) * side).min(size);
        let (right, bottom) = (end(right, camera.width()), end(bottom, camera.height()));
        found.push([left * side, top * side, right, bottom]);
    }
    found
}

#[cfg(test)]
mod tests {
    use foveate_camera::CameraConfig;

    use super::*;

    /// Returns the boxes of a frame of 22x14 pixels whose regions have a side of 4, from marks of
    /// active regions.
    fn boxes(marks: [&str; 4]) -> Vec<[u32; 4]> {
        let mut config = CameraConfig::default();
        (config.frame.width, config.frame.height) = (Some(22), Some(14));
        config.region.size = 4;
        let camera = config.validate_for_frames(22, 14).unwrap();
        let active: Vec<bool> = marks.concat().chars().map(|mark| mark == '#').collect();
        active_groups(&camera, &active)
    }

    #[test]
    fn groups_touch_at_sides_and_corners_and_end_at_the_frame() {
        assert_eq!(boxes(["......"; 4]), Vec::<[u32; 4]>::new());
        assert_eq!(boxes(["######"; 4]), [[0, 0, 22, 14]]);
        let corners = boxes(["#....#", ".#..#.", "......", "#....."]);
        assert_eq!(corners, [[0, 0, 8, 8], [16, 0, 22, 8], [0, 12, 4, 14]]);
        // A group is whole if it goes back to the left and up.
        assert_eq!(boxes(["....#.", "#...#.", ".#.#..", "..#..."]), [[0, 0, 20, 14]]);
    }
}
