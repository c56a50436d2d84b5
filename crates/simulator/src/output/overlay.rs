// SPDX-License-Identifier: MIT OR Apache-2.0
//! The original frame, dimmed, with what the camera thinks of every region in colour, and below it a
//! legend and the share of active regions over time.
//!
//! The colours are of the Okabe-Ito palette, made to be told apart with any colour vision; active
//! regions have an outline besides.

use foveate_frame::Raster;

use super::canvas::{Canvas, Colour, Layout};
use super::font;
use super::gallery::Painter;
use super::png::low_byte;
use super::sink::Step;
use super::strip::Strip;
use foveate_frame::convert_depth;

/// A region with SRS and TRS: bluish green.
const ACTIVE: Colour = [0, 158, 115];
/// SRS only, worth seeing but nothing new: orange.
const SPATIAL_ONLY: Colour = [230, 159, 0];
/// TRS only, something new but not worth seeing: sky blue.
const TEMPORAL_ONLY: Colour = [86, 180, 233];
/// The outline of active regions and their share over time: bluish green, brighter.
const OUTLINE: Colour = [70, 230, 180];
/// Regions with sides below this are drawn without lines, which would cover them.
const SMALLEST_GRID: u32 = 6;

/// Draws overlays and remembers the share of active regions so far.
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
        let regions = step.design.regions();
        let active = step.outcome.active.iter().map(|&bit| u32::from(bit)).sum();
        draw_legend(&mut canvas, layout, active, regions);
        self.strip.push(active.into(), (layout.width / Strip::bar(layout)) as usize);
        self.strip.draw(&mut canvas, layout, regions.into(), OUTLINE);
        canvas
    }
}

fn draw_frame(canvas: &mut Canvas, frame: &Raster, step: &Step<'_>, layout: Layout) {
    let side = step.design.region_size();
    let cell = side * layout.scale;
    for y in 0..frame.height() {
        for x in 0..frame.width() {
            let region = y / side * step.design.columns() + x / side;
            let grey = u32::from(convert_depth(frame.get(x, y), frame.bits(), 8));
            let colour = shade(grey, tint(step, region));
            let scale = layout.scale;
            canvas.fill(x * scale, y * scale, scale, scale, colour);
        }
    }
    if cell < SMALLEST_GRID {
        return;
    }
    for (column, row) in (0..step.design.rows())
        .flat_map(|row| (0..step.design.columns()).map(move |column| (column, row)))
    {
        let (left, top) = (column * cell, row * cell);
        let width = cell.min(layout.frame_width - left);
        let height = cell.min(layout.frame_height - top);
        grid(canvas, [left, top, width, 1]);
        grid(canvas, [left, top, 1, height]);
        let region = (row * step.design.columns() + column) as usize;
        if step.outcome.active[region] {
            canvas.frame([left, top, width, height], 1 + cell / 40, OUTLINE);
        }
    }
}

/// Lightens a line.
fn grid(canvas: &mut Canvas, [left, top, width, height]: [u32; 4]) {
    for y in top..top + height {
        let start = 3 * (y as usize * canvas.width as usize + left as usize);
        for value in &mut canvas.rgb[start..start + 3 * width as usize] {
            *value = low_byte((7 * u16::from(*value) + 255) / 8);
        }
    }
}

fn draw_legend(canvas: &mut Canvas, layout: Layout, active: u32, regions: u32) {
    let (dot, top) = (layout.dot, layout.frame_height + 2 * layout.dot);
    let height = font::SIZE.1 * dot;
    let permille = (u64::from(active) * 1000 + u64::from(regions) / 2) / u64::from(regions);
    let share = format!("Active {}.{}%", permille / 10, permille % 10);
    let mut left = 2 * dot;
    for (colour, text) in
        [(ACTIVE, share.as_str()), (SPATIAL_ONLY, "SRS only"), (TEMPORAL_ONLY, "TRS only")]
    {
        canvas.fill(left, top, height, height, colour);
        if colour == ACTIVE {
            canvas.frame([left, top, height, height], dot.div_ceil(2), OUTLINE);
        }
        left = canvas.text(left + height + dot, top, dot, text) + 3 * dot;
    }
}

fn tint(step: &Step<'_>, region: u32) -> Option<Colour> {
    let region = region as usize;
    match (step.outcome.srs[region], step.outcome.trs[region]) {
        (true, true) => Some(ACTIVE),
        (true, false) => Some(SPATIAL_ONLY),
        (false, true) => Some(TEMPORAL_ONLY),
        (false, false) => None,
    }
}

/// Half the grey without a tint, else half of each.
fn shade(grey: u32, tint: Option<Colour>) -> Colour {
    let mixed = match tint {
        Some(tint) => tint.map(|colour| u32::midpoint(grey, colour.into())),
        None => [grey / 2; 3],
    };
    mixed.map(|value| low_byte(u16::try_from(value).unwrap_or(u16::MAX)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protanopia, deuteranopia and tritanopia as matrices on linear RGB (Machado et al. 2009).
    const VISIONS: [[[f64; 3]; 3]; 3] = [
        [
            [0.152_286, 1.052_583, -0.204_868],
            [0.114_503, 0.786_281, 0.099_216],
            [-0.003_882, -0.048_116, 1.051_998],
        ],
        [
            [0.367_322, 0.860_646, -0.227_968],
            [0.280_085, 0.672_501, 0.047_413],
            [-0.011_820, 0.042_940, 0.968_881],
        ],
        [
            [1.255_528, -0.076_749, -0.178_779],
            [-0.078_411, 0.930_809, 0.147_602],
            [0.004_733, 0.691_367, 0.303_900],
        ],
    ];

    fn seen(colour: Colour, vision: [[f64; 3]; 3]) -> [f64; 3] {
        let linear = colour.map(|value| (f64::from(value) / 255.0).powf(2.2));
        vision.map(|row| {
            let sum: f64 = row.iter().zip(linear).map(|(factor, value)| factor * value).sum();
            255.0 * sum.clamp(0.0, 1.0).powf(1.0 / 2.2)
        })
    }

    #[test]
    fn states_can_be_told_apart_with_any_colour_vision() {
        let tints = [Some(ACTIVE), Some(SPATIAL_ONLY), Some(TEMPORAL_ONLY), None];
        for (kind, vision) in VISIONS.into_iter().enumerate() {
            for grey in (0..256).step_by(5) {
                for (index, &first) in tints.iter().enumerate() {
                    for &second in &tints[..index] {
                        let [a, b] = [first, second].map(|tint| seen(shade(grey, tint), vision));
                        let distance =
                            a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                        assert!(distance > 20.0, "{kind} {grey} {first:?} {second:?} {distance}");
                    }
                }
            }
        }
    }
}
