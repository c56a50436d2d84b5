// SPDX-License-Identifier: MIT OR Apache-2.0
//! The moving objects of the street: three lanes of cars, each with its own speed, and pedestrians.

use super::setting::TimeOfDay;
use crate::scenes::canvas::{Canvas, OPAQUE, ShapePainter, UNIT};
use crate::scenes::noise::pick;

/// A lane of the road, on which cars follow each other without end.
struct TrafficLane {
    /// Position of the wheels in units from the top.
    ground: i64,
    /// Direction of the cars: 1 to the right, -1 to the left.
    facing: i64,
    /// Speed in parts of units per frame.
    speed: i64,
    /// Distance from one car to the next in units.
    spacing: i64,
    /// Position of the first car in frame 0, in units.
    start: i64,
    /// True if the cars of this lane are vans.
    has_vans: bool,
}

const LANES: [TrafficLane; 3] = [
    TrafficLane { ground: 158, facing: -1, speed: 72, spacing: 236, start: 186, has_vans: true },
    TrafficLane { ground: 179, facing: -1, speed: 200, spacing: 310, start: 290, has_vans: false },
    TrafficLane { ground: 201, facing: 1, speed: 136, spacing: 268, start: 34, has_vans: false },
];

/// Length of the longest car with the light of its headlights, in units.
const REACH: i64 = 120;

pub(super) fn paint(canvas: &mut Canvas, time_of_day: TimeOfDay, t: u32) {
    for (number, lane) in (0..).zip(&LANES) {
        lane.paint(canvas, time_of_day, t, number);
    }
    pedestrians(canvas, time_of_day, t);
}

impl TrafficLane {
    fn paint(&self, canvas: &mut Canvas, time_of_day: TimeOfDay, t: u32, number: u32) {
        let canvas_width = canvas.parts_wide();
        let spacing = self.spacing * UNIT;
        let shift = self.start * UNIT + self.facing * self.speed * i64::from(t);
        let first = (-REACH * UNIT - shift).div_euclid(spacing);
        let last = (canvas_width + REACH * UNIT - shift).div_euclid(spacing);
        // Only cars that are at least partly on the canvas are painted.
        for car in first..=last {
            let origin = (shift + car * spacing, self.ground * UNIT);
            let car_number = u32::try_from(car.rem_euclid(1 << 20)).expect("20 bits");
            let mut pen =
                ShapePainter { canvas, origin, facing: self.facing, light: time_of_day.light() };
            let body_shade =
                [218, 44, 160, 232, 92][pick(0xCA2, number, car_number, 0, 5) as usize];
            let distance = i64::from(t) * self.speed / UNIT;
            if self.has_vans {
                van(&mut pen, body_shade, distance);
            } else {
                car_body(&mut pen, body_shade, distance);
            }
            if time_of_day == TimeOfDay::Night {
                headlights(&mut pen);
            }
        }
    }
}

/// Converts points in whole units to parts of units.
fn points<const COUNT: usize>(corners: [(i64, i64); COUNT]) -> [(i64, i64); COUNT] {
    corners.map(|(x, y)| (x * UNIT, y * UNIT))
}

/// Paints a car of 50 units that drives to the right. Its wheels touch the road at y = 0.
fn car_body(pen: &mut ShapePainter<'_>, body_shade: u32, distance: i64) {
    shadow(pen, 50);
    pen.polygon(&points([(9, -12), (37, -12), (31, -20), (15, -20)]), body_shade);
    pen.polygon(&points([(12, -12), (22, -12), (22, -18), (16, -18)]), 50);
    pen.polygon(&points([(24, -12), (34, -12), (30, -18), (24, -18)]), 66);
    pen.polygon(&points([(0, -4), (0, -11), (3, -13), (38, -13), (48, -10), (50, -4)]), body_shade);
    pen.rect(0, -5, 50, -3, body_shade / 2 + 12);
    pen.rect(23, -12, 24, -5, body_shade * 3 / 4);
    lights(pen, 50, -9);
    wheel(pen, 10, 5, distance);
    wheel(pen, 40, 5, distance);
}

/// Paints a van of 58 units that drives to the right.
fn van(pen: &mut ShapePainter<'_>, body_shade: u32, distance: i64) {
    shadow(pen, 58);
    pen.polygon(&points([(0, -4), (0, -25), (44, -25), (44, -4)]), body_shade);
    pen.polygon(&points([(43, -4), (43, -25), (49, -24), (56, -13), (58, -4)]), body_shade);
    pen.polygon(&points([(45, -13), (45, -22), (49, -22), (54, -13)]), 56);
    pen.rect(4, -19, 38, -13, if body_shade > 128 { body_shade - 70 } else { body_shade + 70 });
    pen.rect(0, -5, 58, -3, body_shade / 2 + 12);
    lights(pen, 58, -10);
    wheel(pen, 11, 5, distance);
    wheel(pen, 46, 5, distance);
}

fn shadow(pen: &mut ShapePainter<'_>, length: i64) {
    pen.glow_rect([2, -2, length - 2, 2], 8, OPAQUE * 5 / 8);
}

fn lights(pen: &mut ShapePainter<'_>, length: i64, y: i64) {
    pen.glow_rect([length - 4, y, length - 1, y + 3], 250, OPAQUE);
    pen.glow_rect([0, y - 1, 2, y + 2], 120, OPAQUE);
}

/// Paints a wheel whose hub turns with the `distance` that the car has driven, in units.
fn wheel(pen: &mut ShapePainter<'_>, x: i64, radius: i64, distance: i64) {
    pen.disc(x, -radius + 1, radius * UNIT, 24);
    pen.disc(x, -radius + 1, (radius - 2) * UNIT, 176);
    let upright = distance / 4 % 2 == 0;
    let (dx, dy) = if upright { (0, 2) } else { (2, 0) };
    pen.rect(x - dx, -radius + 1 - dy, x + dx + 1, -radius + 2 + dy, 92);
}

fn headlights(pen: &mut ShapePainter<'_>) {
    for (reach, opacity) in [(104, 36), (84, 44), (66, 52)] {
        pen.glow_polygon(&points([(50, -9), (50, -6), (reach, 3), (reach, -6)]), 250, opacity);
    }
    pen.glow_disc(49, -8, 4 * UNIT, 255, OPAQUE / 3);
}

/// Paints the pedestrians on the pavement in front, one every 380 units.
fn pedestrians(canvas: &mut Canvas, time_of_day: TimeOfDay, t: u32) {
    const SPACING: i64 = 380 * UNIT;
    let canvas_width = canvas.parts_wide();
    let shift = 58 * UNIT + 44 * i64::from(t);
    let first = (-20 * UNIT - shift).div_euclid(SPACING);
    let last = (canvas_width + 20 * UNIT - shift).div_euclid(SPACING);
    for person in first..=last {
        let origin = (shift + person * SPACING, 220 * UNIT);
        let mut pen = ShapePainter { canvas, origin, facing: 1, light: time_of_day.light() };
        pedestrian(&mut pen, i64::from(t) * 44);
    }
}

/// Paints a pedestrian of 36 units whose legs and arms swing with the `distance` that was walked,
/// in parts of units.
fn pedestrian(pen: &mut ShapePainter<'_>, distance: i64) {
    const STRIDE: i64 = 12 * UNIT;
    let phase = distance.rem_euclid(2 * STRIDE);
    let swing = phase.min(2 * STRIDE - phase) - STRIDE / 2;
    let leg = |foot: i64| {
        [(-2 * UNIT, -17 * UNIT), (2 * UNIT, -17 * UNIT), (foot + 2 * UNIT, 0), (foot - UNIT, 0)]
    };
    pen.glow_rect([-7, -1, 8, 1], 40, OPAQUE / 3);
    pen.polygon(&leg(-swing), 48);
    pen.polygon(&leg(swing), 30);
    let hand = -swing * 2 / 3;
    pen.polygon(&points([(-4, -29), (4, -29), (3, -15), (-3, -15)]), 236);
    pen.polygon(
        &[
            (-UNIT, -28 * UNIT),
            (UNIT, -28 * UNIT),
            (hand + UNIT, -17 * UNIT),
            (hand - UNIT, -17 * UNIT),
        ],
        150,
    );
    pen.disc(0, -33, 4 * UNIT, 122);
    pen.rect(-4, -38, 4, -34, 36);
}
