// SPDX-License-Identifier: MIT OR Apache-2.0
//! The houses of the street side by side, each with its own height, grey level, roof and windows,
//! and the trees between them.

use super::setting::{GROUND, TimeOfDay};
use crate::scenes::canvas::{OPAQUE, ShapePainter, UNIT};
use crate::scenes::noise::pick;

const SEED: u64 = 0xB01D;

pub(super) fn paint(pen: &mut ShapePainter<'_>, canvas_width: i64, time_of_day: TimeOfDay) {
    let mut left = -14;
    let mut number = 0;
    while left < canvas_width {
        if number % 4 == 3 {
            tree(pen, left + 9, number);
            left += 18;
        }
        let width = 7 * i64::from(5 + pick(SEED, number, 0, 0, 3)) + 5;
        House { number, left, right: left + width, time_of_day }.paint(pen);
        left += width;
        number += 1;
    }
}

struct House {
    number: u32,
    left: i64,
    right: i64,
    time_of_day: TimeOfDay,
}

impl House {
    /// Returns a random number below `bound` for one property of this house.
    fn choose(&self, property: u32, bound: u32) -> u32 {
        pick(SEED, self.number, property, 1, bound)
    }

    fn floors(&self) -> i64 {
        3 + i64::from(self.choose(1, 3))
    }

    fn paint(&self, pen: &mut ShapePainter<'_>) {
        let wall = [112, 168, 136, 188, 150][self.choose(2, 5) as usize];
        let top = GROUND - 14 * self.floors() - 6;
        self.roof(pen, top, wall);
        pen.rect(self.left, top, self.right, GROUND, wall);
        pen.rect(self.left, top, self.left + 1, GROUND, wall - 34);
        pen.rect(self.left, top, self.right, top + 2, wall + 30);
        pen.rect(self.left, GROUND - 3, self.right, GROUND, wall - 44);
        for floor in 0..self.floors() {
            for column in 0..(self.right - self.left - 5) / 14 {
                let spare = (self.right - self.left - 5) % 14 / 2;
                self.window(pen, self.left + 6 + spare + 14 * column, top + 7 + 14 * floor, wall);
            }
        }
    }

    fn roof(&self, pen: &mut ShapePainter<'_>, top: i64, wall: u32) {
        let roof_shade = wall / 2 + 6;
        let (left, right) = (self.left, self.right);
        if self.choose(3, 3) == 0 {
            pen.rect(left + 6, top - 5, left + 18, top, roof_shade + 24);
            return;
        }
        let height = 8 + i64::from(self.choose(4, 8));
        pen.rect(right - 13, top - height - 2, right - 8, top, roof_shade + 20);
        let corners = [
            (left * UNIT, top * UNIT),
            (right * UNIT, top * UNIT),
            ((right - 9) * UNIT, (top - height) * UNIT),
            ((left + 9) * UNIT, (top - height) * UNIT),
        ];
        pen.polygon(&corners, roof_shade);
    }

    /// Paints a window, or a door in some places of the ground floor.
    fn window(&self, pen: &mut ShapePainter<'_>, x: i64, y: i64, wall: u32) {
        // The place identifies the window, so that its random properties are the same every time.
        let place = x.rem_euclid(1 << 20) * 512 + y.rem_euclid(512);
        let place = u32::try_from(place).expect("29 bits");
        let bottom = y + 9;
        if bottom > GROUND - 8 && self.choose(place, 3) == 0 {
            pen.rect(x - 1, y - 1, x + 7, GROUND, wall + 40);
            pen.rect(x, y, x + 6, GROUND, 52);
            return;
        }
        pen.rect(x - 1, y - 1, x + 7, bottom + 1, (wall + 52).min(244));
        let is_lit = self.time_of_day == TimeOfDay::Night && self.choose(place, 5) < 2;
        if is_lit {
            let shade = 150 + 30 * self.choose(place + 1, 3);
            pen.glow_rect([x, y, x + 6, bottom], shade, OPAQUE);
        } else {
            pen.rect(x, y, x + 6, bottom, 58 + 12 * self.choose(place + 2, 3));
            pen.rect(x, y, x + 6, y + 3, 96);
        }
        pen.rect(x + 3, y, x + 4, bottom, (wall + 40).min(220));
    }
}

/// Paints a tree in front of a hedge, with a distant house behind it.
fn tree(pen: &mut ShapePainter<'_>, x: i64, number: u32) {
    pen.rect(x - 9, GROUND - 40, x + 9, GROUND, 186);
    pen.rect(x - 9, GROUND - 12, x + 9, GROUND, 92);
    pen.rect(x - 1, GROUND - 24, x + 2, GROUND, 62);
    let leaves = [(0, -34, 11), (-5, -27, 8), (6, -28, 8), (1, -43, 7), (-3, -38, 8)];
    for (index, (dx, dy, radius)) in (0..).zip(leaves) {
        let shade = 74 + 9 * pick(SEED, number, 9, index, 4);
        pen.disc(x + dx, GROUND + dy, radius * UNIT, shade);
    }
}
