// SPDX-License-Identifier: MIT OR Apache-2.0
//! The street scene: a backdrop that is painted once, and the objects that move in front of it.

mod buildings;
mod setting;
mod traffic;
mod weather;

use crate::scenes::canvas::{Canvas, ShapePainter, UNIT};
use setting::GROUND;

pub(crate) use setting::TimeOfDay;

/// Upper and lower border of the road in units from the top.
const ROAD: (i64, i64) = (142, 206);

/// A street of one size and one time of day.
#[derive(Clone, Debug)]
pub(crate) struct Street {
    backdrop: Canvas,
    time_of_day: TimeOfDay,
}

impl Street {
    pub(crate) fn new(width: u32, height: u32, time_of_day: TimeOfDay) -> Self {
        let mut backdrop = Canvas::new(width, height);
        paint_backdrop(&mut backdrop, time_of_day);
        Self { backdrop, time_of_day }
    }

    /// Returns the canvas with everything that does not move.
    pub(crate) fn backdrop(&self) -> &Canvas {
        &self.backdrop
    }

    /// Returns the canvas of the street in frame `t`.
    pub(crate) fn canvas_at(&self, t: u32) -> Canvas {
        let mut canvas = self.backdrop.clone();
        traffic::paint(&mut canvas, self.time_of_day, t);
        if self.time_of_day == TimeOfDay::Night {
            weather::rain(&mut canvas, t);
        }
        canvas
    }
}

fn paint_backdrop(canvas: &mut Canvas, time_of_day: TimeOfDay) {
    let canvas_width = canvas.parts_wide() / UNIT + 1;
    let mut pen = ShapePainter { canvas, origin: (0, 0), facing: 1, light: time_of_day.light() };
    for step in 0..GROUND / 4 {
        let shade = u32::try_from(196 + step).expect("a shade");
        // Each band overlaps the next one, so that no seam is visible.
        pen.rect(0, 4 * step, canvas_width, 4 * step + 8, shade);
    }
    weather::sky(&mut pen, canvas_width, time_of_day);
    buildings::paint(&mut pen, canvas_width, time_of_day);
    paint_road(&mut pen, canvas_width);
    weather::lamps(&mut pen, canvas_width, time_of_day);
}

fn paint_road(pen: &mut ShapePainter<'_>, canvas_width: i64) {
    let (top, bottom) = ROAD;
    pen.rect(0, GROUND, canvas_width, top, 172);
    pen.rect(0, top - 3, canvas_width, top + 1, 206);
    for row in top..bottom {
        let shade = u32::try_from(78 + (row - top) / 4).expect("a shade");
        pen.rect(0, row, canvas_width, row + 2, shade);
    }
    for lane in [163, 184] {
        for dash in 0..=canvas_width / 30 {
            pen.rect(30 * dash + 6, lane, 30 * dash + 22, lane + 2, 226);
        }
    }
    pen.rect(0, bottom, canvas_width, bottom + 4, 206);
    pen.rect(0, bottom + 3, canvas_width, 225, 164);
    for slab in 0..=canvas_width / 20 {
        pen.rect(20 * slab + 11, bottom + 3, 20 * slab + 12, 224, 140);
    }
}
