// SPDX-License-Identifier: MIT OR Apache-2.0
//! The overlay: the original frame, dimmed, with the decision about every region in colour. Below
//! it are a legend and the share of active regions over time.
//!
//! The colours are those of the palette. Active regions also have an outline. An arrow shows the
//! displacement of a region, bright if `flow` votes for the region and faint otherwise. Without
//! scores it is bright if the region is relevant. Classes of regions have marks and a legend.

use foveate_camera::{Camera, Displacement, RegionAction};
use foveate_engine::FrameOutcome;
use foveate_frame::{ByteFrame, convert_depth};
use foveate_pictures::palette::{ACTIVE, ACTIVE_BRIGHT, CHANGED, Colour, RELEVANT};

use super::activity_chart::ActivityChart;
use super::arrow::Arrow;
use super::canvas::{PictureCanvas, PictureLayout, TEXT};
use super::class_marks::ClassMarks;
use super::font;
use super::picture_series::PicturePainter;
use super::raw_image::to_byte;
use super::sink::SinkFrame;

/// Regions with smaller sides are drawn without lines, which would cover them.
const SMALLEST_GRID: u32 = 6;
/// The colour of arrows, which no decision has.
const ARROW: Colour = [255, 255, 255];
/// The opacity of the arrow of a region for which `flow` does not vote.
const FAINT: f64 = 0.3;
/// The length of the shortest arrow in pixels of the picture.
const SHORTEST_ARROW: f64 = 3.0;

/// The painter of overlays. It records the share of active regions so far.
pub(super) struct OverlayPainter {
    /// False for a stream of packets without scores.
    has_scores: bool,
    activity_chart: ActivityChart,
}

impl OverlayPainter {
    pub(super) fn new(has_scores: bool) -> Self {
        Self { has_scores, activity_chart: ActivityChart::default() }
    }
}

/// A frame and the decisions that an overlay shows.
#[derive(Clone, Copy, Debug)]
pub struct OverlayFrame<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// The outcome of the frame, with its scores.
    pub outcome: &'a FrameOutcome,
    /// The pixels under the decisions, in the size of the camera's frames.
    pub frame: &'a ByteFrame,
    /// True if the regions have the classes of the camera's configuration. The marks of other
    /// classes are not known.
    pub has_own_map: bool,
}

/// Draws the overlay of a frame as a run does, without the legend and the chart below it. Returns the
/// width, the height, and red, green and blue of every pixel. Small frames are enlarged by a whole
/// factor.
#[must_use]
pub fn draw_overlay(shown: OverlayFrame<'_>) -> (u32, u32, Vec<u8>) {
    let layout = PictureLayout::of_camera(shown.camera);
    let mut canvas = PictureCanvas::new(layout.frame_width, layout.frame_height);
    shown.draw(&mut canvas, layout, true);
    (canvas.width, canvas.height, canvas.rgb)
}

impl OverlayFrame<'_> {
    /// Draws the frame, the decisions, the marks of classes and the arrows.
    fn draw(&self, canvas: &mut PictureCanvas, layout: PictureLayout, has_scores: bool) {
        draw_frame(canvas, self, layout);
        let marks = ClassMarks::of_camera(self.camera).filter(|_| self.has_own_map);
        if let Some(marks) = marks {
            marks.draw(canvas, self.camera.region_size() * layout.scale, layout);
        }
        draw_arrows(canvas, self, layout, has_scores);
    }
}

impl PicturePainter for OverlayPainter {
    fn paint(&mut self, sink_frame: &SinkFrame<'_>) -> PictureCanvas {
        let layout = PictureLayout::of_camera(sink_frame.camera);
        let line = (font::SIZE.1 + 4) * layout.dot;
        let marks = ClassMarks::of_camera(sink_frame.camera);
        let legend = if marks.is_some() { 2 * line } else { line };
        let height = layout.frame_height + legend + ActivityChart::HEIGHT_DOTS * layout.dot;
        let mut canvas = PictureCanvas::new(layout.width, height);
        let shown = OverlayFrame {
            camera: sink_frame.camera,
            outcome: sink_frame.outcome,
            frame: &sink_frame.source.frame,
            // A recording has the version of the map and not its classes. Version 0 is the map of
            // the design; the classes of any other version are not known.
            has_own_map: sink_frame.map_version.is_none_or(|version| version == 0),
        };
        shown.draw(&mut canvas, layout, self.has_scores);
        let regions = sink_frame.camera.regions();
        let active = sink_frame.outcome.active.iter().map(|&bit| u32::from(bit)).sum();
        draw_legend(&mut canvas, layout, active, sink_frame.camera);
        if let Some(marks) = marks {
            marks.draw_legend(&mut canvas, layout, layout.frame_height + line + 2 * layout.dot);
        }
        self.activity_chart
            .push(active.into(), (layout.width / ActivityChart::bar_width(layout)) as usize);
        self.activity_chart.draw(&mut canvas, layout, regions.into(), ACTIVE_BRIGHT);
        canvas
    }
}

fn draw_frame(canvas: &mut PictureCanvas, shown: &OverlayFrame<'_>, layout: PictureLayout) {
    let OverlayFrame { camera, outcome, frame, .. } = *shown;
    let side = camera.region_size();
    let cell = side * layout.scale;
    for y in 0..frame.height() {
        for x in 0..frame.width() {
            let region = y / side * camera.columns() + x / side;
            let grey = u32::from(convert_depth(frame.get(x, y), frame.bits(), 8));
            let colour = tinted(grey, region_tint(outcome, region));
            let scale = layout.scale;
            canvas.fill_rectangle(x * scale, y * scale, scale, scale, colour);
        }
    }
    if cell < SMALLEST_GRID {
        return;
    }
    for (column, row) in
        (0..camera.rows()).flat_map(|row| (0..camera.columns()).map(move |column| (column, row)))
    {
        let area @ [left, top, width, height] = layout.region_area(cell, (column, row));
        lighten_line(canvas, [left, top, width, 1]);
        lighten_line(canvas, [left, top, 1, height]);
        let region = (row * camera.columns() + column) as usize;
        if outcome.active[region] {
            canvas.draw_border(area, 1 + cell / 40, ACTIVE_BRIGHT);
        }
        if outcome.actions[region] == RegionAction::Summarize {
            canvas.draw_border(area, 1, TEXT);
        }
    }
}

/// Draws an arrow from the centre of each region whose content has moved. The bright ones are drawn
/// last. Without scores, SRS takes the place of the vote.
fn draw_arrows(
    canvas: &mut PictureCanvas,
    shown: &OverlayFrame<'_>,
    layout: PictureLayout,
    has_scores: bool,
) {
    let OverlayFrame { camera, outcome, .. } = shown;
    let cell = camera.region_size() * layout.scale;
    let mut features = camera.features().iter().zip(&outcome.scores);
    let found = features.find_map(|(feature, scores)| Some((feature, scores, feature.radius()?)));
    let Some((feature, scores, radius)) = found.filter(|_| cell >= SMALLEST_GRID) else { return };
    for bright in [false, true] {
        for (region, displacement) in (0..).zip(&outcome.displacements) {
            let votes = match has_scores {
                true => scores[region as usize] >= feature.min_score(),
                false => outcome.srs[region as usize],
            };
            if *displacement == Displacement::default() || votes != bright {
                continue;
            }
            let at = (region % camera.columns(), region / camera.columns());
            let arrow = region_arrow(at, *displacement, cell, radius);
            arrow.draw(canvas, ARROW, if bright { 1.0 } else { FAINT });
        }
    }
}

/// Returns the arrow of the region in a column and row. Its length is in proportion to the
/// displacement, and the longest reaches into the next region.
fn region_arrow(at: (u32, u32), displacement: Displacement, cell: u32, radius: u32) -> Arrow {
    let (cell, radius) = (f64::from(cell), f64::from(radius));
    let pixel = (1.2 * cell / (radius + 1.0)).max(SHORTEST_ARROW);
    let tail = [at.0, at.1].map(|place| (f64::from(place) + 0.5) * cell);
    let [dx, dy] = [displacement.dx, displacement.dy].map(f64::from);
    let tip = [tail[0] + dx * pixel, tail[1] + dy * pixel];
    Arrow { tail, tip, head_width: (cell * 0.36).clamp(4.0, 16.0) }
}

/// Lightens the pixels of a line.
fn lighten_line(canvas: &mut PictureCanvas, [left, top, width, height]: [u32; 4]) {
    for y in top..top + height {
        let start = 3 * (y as usize * canvas.width as usize + left as usize);
        for value in &mut canvas.rgb[start..start + 3 * width as usize] {
            *value = to_byte((7 * u16::from(*value) + 255) / 8);
        }
    }
}

fn draw_legend(canvas: &mut PictureCanvas, layout: PictureLayout, active: u32, camera: &Camera) {
    let regions = camera.regions();
    let (dot, top) = (layout.dot, layout.frame_height + 2 * layout.dot);
    let height = font::SIZE.1 * dot;
    let permille = (u64::from(active) * 1000 + u64::from(regions) / 2) / u64::from(regions);
    let share = format!("Active {}.{}%", permille / 10, permille % 10);
    let mut left = 2 * dot;
    for (colour, text) in [(ACTIVE, share.as_str()), (RELEVANT, "SRS only"), (CHANGED, "TRS only")]
    {
        canvas.fill_rectangle(left, top, height, height, colour);
        if colour == ACTIVE {
            canvas.draw_border([left, top, height, height], dot.div_ceil(2), ACTIVE_BRIGHT);
        }
        left = canvas.draw_text(left + height + dot, top, dot, text) + 3 * dot;
    }
    if camera.periphery().is_some() {
        canvas.draw_border([left, top, height, height], dot.div_ceil(2), TEXT);
        left = canvas.draw_text(left + height + dot, top, dot, "Means") + 3 * dot;
    }
    if camera.displacement_feature().is_some() {
        let [start, top_edge, side] = [left, top, height].map(f64::from);
        let middle = top_edge + side / 2.0;
        let (tail, tip) = ([start, middle], [start + 2.0 * side, middle]);
        Arrow { tail, tip, head_width: side }.draw(canvas, ARROW, 1.0);
        canvas.draw_text(left + 2 * height + dot, top, dot, "Moved");
    }
}

fn region_tint(outcome: &FrameOutcome, region: u32) -> Option<Colour> {
    let region = region as usize;
    match (outcome.srs[region], outcome.trs[region]) {
        (true, true) => Some(ACTIVE),
        (true, false) => Some(RELEVANT),
        (false, true) => Some(CHANGED),
        (false, false) => None,
    }
}

/// Returns half the grey level without a tint, otherwise the mean of grey level and tint.
fn tinted(grey: u32, tint: Option<Colour>) -> Colour {
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
    fn states_are_distinguishable_with_any_colour_vision() {
        let tints = [Some(ACTIVE), Some(RELEVANT), Some(CHANGED), None];
        for (kind, vision) in VISIONS.into_iter().enumerate() {
            for grey in (0..256).step_by(5) {
                for (index, &first) in tints.iter().enumerate() {
                    for &second in &tints[..index] {
                        let [a, b] = [first, second].map(|tint| tinted(grey, tint));
                        let distance = distance(a, b, vision);
                        assert!(distance > 20.0, "{kind} {grey} {first:?} {second:?} {distance}");
                    }
                }
            }
        }
    }
}
