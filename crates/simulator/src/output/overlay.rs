// SPDX-License-Identifier: MIT OR Apache-2.0
//! The overlay: the original frame, dimmed, with the decision about every region in colour. Below
//! it are a legend and the share of active regions over time.
//!
//! The colours are those of the palette. Active regions also have an outline.

use foveate_camera::{Action, Camera};
use foveate_frame::{Raster, convert_depth};
use foveate_pictures::palette::{ACTIVE, ACTIVE_BRIGHT, CHANGED, Colour, RELEVANT};

use super::canvas::{Canvas, Layout, TEXT};
use super::font;
use super::gallery::Painter;
use super::picture::low_byte;
use super::sink::Step;
use super::strip::Strip;

/// Regions with smaller sides are drawn without lines, which would cover them.
const SMALLEST_GRID: u32 = 6;

/// The painter of overlays. It records the share of active regions so far.
#[derive(Default)]
pub(super) struct Overlay {
    strip: Strip,
}

impl Painter for Overlay {
    fn paint(&mut self, step: &Step<'_>) -> Canvas {
        let frame = &step.source.frame;
        let layout = Layout::new(frame.width(), frame.height());
        let legend = (font::SIZE.1 + 4) * layout.dot;
        let height = layout.frame_height + legend + Strip::DOTS * layout.dot;
        let mut canvas = Canvas::new(layout.width, height);
        draw_frame(&mut canvas, frame, step, layout);
        let regions = step.camera.regions();
        let active = step.outcome.active.iter().map(|&bit| u32::from(bit)).sum();
        draw_legend(&mut canvas, layout, active, step.camera);
        self.strip.push(active.into(), (layout.width / Strip::bar(layout)) as usize);
        self.strip.draw(&mut canvas, layout, regions.into(), ACTIVE_BRIGHT);
        canvas
    }
}

fn draw_frame(canvas: &mut Canvas, frame: &Raster, step: &Step<'_>, layout: Layout) {
    let side = step.camera.region_size();
    let cell = side * layout.scale;
    for y in 0..frame.height() {
        for x in 0..frame.width() {
            let region = y / side * step.camera.columns() + x / side;
            let grey = u32::from(convert_depth(frame.get(x, y), frame.bits(), 8));
            let colour = shade(grey, tint(step, region));
            let scale = layout.scale;
            canvas.fill(x * scale, y * scale, scale, scale, colour);
        }
    }
    if cell < SMALLEST_GRID {
        return;
    }
    for (column, row) in (0..step.camera.rows())
        .flat_map(|row| (0..step.camera.columns()).map(move |column| (column, row)))
    {
        let (left, top) = (column * cell, row * cell);
        let width = cell.min(layout.frame_width - left);
        let height = cell.min(layout.frame_height - top);
        grid(canvas, [left, top, width, 1]);
        grid(canvas, [left, top, 1, height]);
        let region = (row * step.camera.columns() + column) as usize;
        if step.outcome.active[region] {
            canvas.frame([left, top, width, height], 1 + cell / 40, ACTIVE_BRIGHT);
        }
        if step.outcome.actions[region] == Action::Summarize {
            canvas.frame([left, top, width, height], 1, TEXT);
        }
    }
}

/// Lightens the pixels of a line.
fn grid(canvas: &mut Canvas, [left, top, width, height]: [u32; 4]) {
    for y in top..top + height {
        let start = 3 * (y as usize * canvas.width as usize + left as usize);
        for value in &mut canvas.rgb[start..start + 3 * width as usize] {
            *value = low_byte((7 * u16::from(*value) + 255) / 8);
        }
    }
}

fn draw_legend(canvas: &mut Canvas, layout: Layout, active: u32, camera: &Camera) {
    let regions = camera.regions();
    let (dot, top) = (layout.dot, layout.frame_height + 2 * layout.dot);
    let height = font::SIZE.1 * dot;
    let permille = (u64::from(active) * 1000 + u64::from(regions) / 2) / u64::from(regions);
    let share = format!("Active {}.{}%", permille / 10, permille % 10);
    let mut left = 2 * dot;
    for (colour, text) in [(ACTIVE, share.as_str()), (RELEVANT, "SRS only"), (CHANGED, "TRS only")]
    {
        canvas.fill(left, top, height, height, colour);
        if colour == ACTIVE {
            canvas.frame([left, top, height, height], dot.div_ceil(2), ACTIVE_BRIGHT);
        }
        left = canvas.text(left + height + dot, top, dot, text) + 3 * dot;
    }
    if camera.periphery().is_some() {
        canvas.frame([left, top, height, height], dot.div_ceil(2), TEXT);
        canvas.text(left + height + dot, top, dot, "Means");
    }
}

fn tint(step: &Step<'_>, region: u32) -> Option<Colour> {
    let region = region as usize;
    match (step.outcome.srs[region], step.outcome.trs[region]) {
        (true, true) => Some(ACTIVE),
        (true, false) => Some(RELEVANT),
        (false, true) => Some(CHANGED),
        (false, false) => None,
    }
}

/// Returns half the grey level without a tint, otherwise the mean of grey level and tint.
fn shade(grey: u32, tint: Option<Colour>) -> Colour {
    let mixed = match tint {
        Some(tint) => tint.map(|colour| u32::midpoint(grey, colour.into())),
        None => [grey / 2; 3],
    };
    mixed.map(|value| u8::try_from(value).expect("between two bytes"))
}

#[cfg(test)]
mod tests {
    use foveate_pictures::palette::vision::{VISIONS, distance};

    use super::*;

    #[test]
    fn states_can_be_told_apart_with_any_colour_vision() {
        let tints = [Some(ACTIVE), Some(RELEVANT), Some(CHANGED), None];
        for (kind, vision) in VISIONS.into_iter().enumerate() {
            for grey in (0..256).step_by(5) {
                for (index, &first) in tints.iter().enumerate() {
                    for &second in &tints[..index] {
                        let [a, b] = [first, second].map(|tint| shade(grey, tint));
                        let distance = distance(a, b, vision);
                        assert!(distance > 20.0, "{kind} {grey} {first:?} {second:?} {distance}");
                    }
                }
            }
        }
    }
}
