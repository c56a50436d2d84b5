// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sky, the weather and the street lamps: clouds by day, stars and rain at night. The lamps are
//! lit at night.

use super::setting::{GROUND, TimeOfDay};
use crate::scenes::canvas::{Canvas, OPAQUE, ShapePainter, UNIT, UNITS_HIGH};
use crate::scenes::noise::pick;

const SEED: u64 = 0x3EA7;

pub(super) fn sky(pen: &mut ShapePainter<'_>, canvas_width: i64, time_of_day: TimeOfDay) {
    match time_of_day {
        TimeOfDay::Day => {
            for cloud in 0..=canvas_width / 90 {
                let number = u32::try_from(cloud).expect("few clouds");
                let x = 90 * cloud + i64::from(pick(SEED, number, 0, 0, 50));
                let y = 14 + i64::from(pick(SEED, number, 1, 0, 18));
                for (dx, dy, radius) in [(0, 0, 6), (8, -3, 8), (17, -1, 7), (25, 1, 5)] {
                    pen.disc(x + dx, y + dy, radius * UNIT, 246);
                }
            }
        }
        TimeOfDay::Night => {
            for star in 0..=canvas_width / 9 {
                let number = u32::try_from(star).expect("few stars");
                let x = 9 * star + i64::from(pick(SEED, number, 2, 0, 9));
                let y = i64::from(pick(SEED, number, 3, 0, 60));
                pen.glow_disc(x, y, UNIT * 3 / 4, 120 + pick(SEED, number, 4, 0, 100), OPAQUE);
            }
        }
    }
}

/// Paints the street lamps on the far pavement.
pub(super) fn lamps(pen: &mut ShapePainter<'_>, canvas_width: i64, time_of_day: TimeOfDay) {
    for lamp in 0..=canvas_width / 112 {
        let x = 112 * lamp + 66;
        pen.rect(x, GROUND - 62, x + 2, GROUND + 10, 46);
        pen.rect(x - 9, GROUND - 63, x + 2, GROUND - 61, 46);
        pen.rect(x - 12, GROUND - 63, x - 5, GROUND - 59, 70);
        if time_of_day == TimeOfDay::Night {
            pen.glow_rect([x - 12, GROUND - 60, x - 5, GROUND - 58], 255, OPAQUE);
            for radius in [26, 18, 11, 6] {
                pen.glow_disc(x - 8, GROUND - 58, radius * UNIT, 230, 22);
            }
        }
    }
}

/// Paints the streaks of rain. Each falls at its own speed, and the wind slants them.
pub(super) fn rain(canvas: &mut Canvas, t: u32) {
    const LENGTH: i64 = 13;
    let canvas_width = canvas.parts_wide() / UNIT + 1;
    let fall_height = (UNITS_HIGH + 2 * LENGTH) * UNIT;
    for drop in 0..=canvas_width / 2 {
        let number = u32::try_from(drop).expect("few drops");
        let speed = UNIT * (11 + i64::from(pick(SEED, number, 5, 0, 6)));
        let distance = i64::from(pick(SEED, number, 6, 0, 1 << 14)) + speed * i64::from(t);
        let fall_number = u32::try_from(distance / fall_height % (1 << 20)).expect("20 bits");
        let (min, span) = (-20, u32::try_from(canvas_width + 40).expect("a width in units"));
        // A drop begins every fall at another column.
        let x = UNIT * (min + i64::from(pick(SEED, number, 7, fall_number, span)));
        let y = distance % fall_height - LENGTH * UNIT;
        let mut pen = ShapePainter { canvas, origin: (x - y / 6, y), facing: 1, light: 256 };
        let bottom = LENGTH * UNIT;
        pen.glow_polygon(
            &[(0, 0), (UNIT, 0), (UNIT - bottom / 6, bottom), (-bottom / 6, bottom)],
            170,
            OPAQUE * 3 / 8,
        );
    }
}
