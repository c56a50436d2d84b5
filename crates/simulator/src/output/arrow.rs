// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrows with smooth edges and a dark outline, so that they are visible on bright and on dark
//! content.
//!
//! The coverage of a pixel of the picture follows from the distance of its centre to the shape.

use foveate_output::palette::Colour;

use super::canvas::{self, BACKGROUND, PictureCanvas};

/// The width of the outline in pixels of the picture.
const OUTLINE: f64 = 1.25;
/// The share of the size by which a head is longer than it is wide.
const HEAD_LENGTH: f64 = 1.1;
/// The share of its length that the head of a short arrow takes.
const LARGEST_HEAD: f64 = 0.75;

/// A point or a direction in pixels of the picture.
type Point = [f64; 2];

/// An arrow from one point to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrow {
    pub(super) tail: Point,
    pub(super) tip: Point,
    /// The width of the head in pixels of the picture. The shaft has a fourth of it.
    pub(super) head_width: f64,
}

impl Arrow {
    /// Draws the arrow in a colour. `opacity` is 1 for an arrow that hides what is behind it.
    pub(super) fn draw(self, canvas: &mut PictureCanvas, colour: Colour, opacity: f64) {
        let margin = self.head_width / 2.0 + OUTLINE + 1.0;
        let [columns, rows] = [0, 1].map(|axis| {
            let (one, other) = (self.tail[axis], self.tip[axis]);
            pixel_number(one.min(other) - margin)..pixel_number(one.max(other) + margin) + 1
        });
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let distance = self.distance([x, y].map(|place| f64::from(place) + 0.5));
            let inside = coverage(distance);
            let mixed = canvas::mix(BACKGROUND, colour, inside);
            canvas.blend(x, y, mixed, opacity * coverage(distance - OUTLINE));
        }
    }

    /// Returns the distance of a point to the arrow, which is negative inside.
    fn distance(self, point: Point) -> f64 {
        let along = [self.tip[0] - self.tail[0], self.tip[1] - self.tail[1]];
        let length = along[0].hypot(along[1]).max(f64::EPSILON);
        let offset = [point[0] - self.tail[0], point[1] - self.tail[1]];
        // The coordinates of the point along the arrow, and across it on either side.
        let u = (offset[0] * along[0] + offset[1] * along[1]) / length;
        let v = ((offset[1] * along[0] - offset[0] * along[1]) / length).abs();
        let head = (HEAD_LENGTH * self.head_width).min(LARGEST_HEAD * length);
        let base = length - head;
        let radius = self.head_width / 8.0;
        let shaft = (u - u.clamp(radius.min(base), base)).hypot(v) - radius;
        let half = self.head_width / 2.0;
        let slope = head.hypot(half);
        let triangle = (base - u).max(((u - length) * half + v * head) / slope);
        shaft.min(triangle)
    }
}

/// Returns the number of the pixel at a place; 0 for places before the picture.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pictures have fewer than 2^32 pixels a side, and places before them become 0"
)]
fn pixel_number(place: f64) -> u32 {
    place as u32
}

/// Returns the part of a pixel that a shape covers, from the distance of its centre.
fn coverage(distance: f64) -> f64 {
    (0.5 - distance).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::canvas::TEXT;

    const SIDE: u32 = 32;

    /// Returns the pixels of an arrow on grey: `#` for its colour, `o` for its outline.
    fn drawn(tail: Point, tip: Point) -> Vec<String> {
        let mut canvas = PictureCanvas::new(SIDE, SIDE);
        canvas.fill_rectangle(0, 0, SIDE, SIDE, [100; 3]);
        Arrow { tail, tip, head_width: 8.0 }.draw(&mut canvas, TEXT, 1.0);
        let mark = |pixel: &[u8]| match pixel[0] {
            0..60 => 'o',
            200.. => '#',
            _ => ' ',
        };
        let row = |row: &[u8]| row.chunks(3).map(mark).collect::<String>().trim_end().to_owned();
        canvas.rgb.chunks(3 * SIDE as usize).map(row).collect()
    }

    fn widths(rows: &[String], mark: char) -> Vec<usize> {
        rows.iter().map(|row| row.matches(mark).count()).collect()
    }

    /// A thin shaft leads from the tail to a head that narrows to the tip.
    #[test]
    fn the_head_is_at_the_tip() {
        let down = widths(&drawn([16.0, 4.0], [16.0, 26.0]), '#');
        let widest = down.iter().position(|&width| width == 6).unwrap();
        assert!((16..20).contains(&widest), "{down:?}");
        assert!(down[6..16].iter().all(|&width| width == 2), "{down:?}");
        assert!(down[widest..26].is_sorted_by(|one, next| one >= next), "{down:?}");
        assert_eq!(down[27..], [0; 5]);
        let up = widths(&drawn([16.0, 28.0], [16.0, 6.0]), '#');
        assert_eq!(up, down.into_iter().rev().collect::<Vec<_>>());
    }

    #[test]
    fn an_outline_is_all_around() {
        let rows = drawn([6.0, 16.0], [26.0, 16.0]);
        for row in rows.iter().filter(|row| row.contains('#')) {
            let inside = row.trim();
            assert!(inside.starts_with('o') && inside.ends_with('o'), "{rows:#?}");
        }
    }

    #[test]
    fn a_faint_arrow_lets_the_picture_through_and_parts_outside_are_left_out() {
        let mut canvas = PictureCanvas::new(SIDE, SIDE);
        canvas.fill_rectangle(0, 0, SIDE, SIDE, [100; 3]);
        Arrow { tail: [2.0, 16.0], tip: [80.0, 16.0], head_width: 8.0 }.draw(
            &mut canvas,
            [200; 3],
            0.5,
        );
        let at = 3 * (16 * SIDE as usize + 16);
        assert!((140..160).contains(&canvas.rgb[at]), "{}", canvas.rgb[at]);
        Arrow { tail: [2.0, 2.0], tip: [-9.0, -9.0], head_width: 8.0 }.draw(
            &mut canvas,
            [200; 3],
            1.0,
        );
        assert!(canvas.rgb[0] > 100);
    }
}
