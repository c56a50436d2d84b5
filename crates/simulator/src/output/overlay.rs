// SPDX-License-Identifier: MIT OR Apache-2.0
//! The overlay: the original frame with what is sent of it. Below it are a legend and the share of sent
//! regions over time.
//!
//! In the usual style the regions that are sent are bright, those of which only means are sent are
//! tinted and have a thin border, and all others are dark: as on the live page. In the style with
//! outlines the frame is dimmed, and the colour of a region says which of its two conditions holds. An
//! arrow shows the displacement of a region, bright if `flow` votes for the region and faint otherwise.
//! Without scores it is bright if the region is relevant. Classes of regions have marks.

use foveate_camera::{Camera, Displacement, RegionAction};
use foveate_engine::FrameOutcome;
use foveate_output::palette::{ACTIVE, ACTIVE_BRIGHT, CHANGED, Colour, RELEVANT, SERIES};
use foveate_pixels::{ByteFrame, convert_depth};

use super::OverlayStyle;
use super::activity_chart::ActivityChart;
use super::arrow::Arrow;
use super::canvas::{PictureCanvas, PictureLayout, TEXT, mix};
use super::class_marks::ClassMarks;
use super::legend::{Legend, LegendKey, LegendMark, NOT_SENT, SENT};
use super::picture_series::PicturePainter;
use super::raw_image::to_byte;
use super::sink::SinkFrame;

/// Regions with smaller sides are drawn without lines, which would cover them.
const SMALLEST_GRID: u32 = 6;
/// The colour of arrows. They have a dark outline.
const ARROW: Colour = [255, 255, 255];
/// The opacity of the arrow of a region for which `flow` does not vote.
const FAINT: f64 = 0.3;
/// The length of the shortest arrow in pixels of the picture.
const SHORTEST_ARROW: f64 = 3.0;
/// The colour of regions of which only means are sent, and its opacity.
const MEANS: (Colour, f64) = (SERIES[2], 0.47);
/// The share of brightness that regions keep that are not sent.
const DARK: f64 = 0.27;

/// The painter of overlays. It records the share of active regions so far.
pub(super) struct OverlayPainter {
    /// False for a stream of packets without scores.
    has_scores: bool,
    style: OverlayStyle,
    activity_chart: ActivityChart,
}

impl OverlayPainter {
    pub(super) fn new(style: OverlayStyle, has_scores: bool) -> Self {
        Self { has_scores, style, activity_chart: ActivityChart::default() }
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
    /// The style.
    pub style: OverlayStyle,
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
        match self.style {
            OverlayStyle::Sent => draw_sent(canvas, self, layout),
            OverlayStyle::Outlines => draw_outlines(canvas, self, layout),
        }
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
        let camera = sink_frame.camera;
        let active = sink_frame.outcome.active.iter().map(|&bit| u32::from(bit)).sum();
        let legend = Legend::new(legend_keys(camera, self.style, active), layout);
        let chart = ActivityChart::HEIGHT_DOTS * layout.dot;
        let height = layout.frame_height + legend.height + chart;
        let mut canvas = PictureCanvas::new(layout.width, height);
        let shown = OverlayFrame {
            camera,
            outcome: sink_frame.outcome,
            frame: &sink_frame.source.frame,
            // A recording has the version of the map and not its classes. Version 0 is the map of
            // the design; the classes of any other version are not known.
            has_own_map: sink_frame.map_version.is_none_or(|version| version == 0),
            style: self.style,
        };
        shown.draw(&mut canvas, layout, self.has_scores);
        legend.draw(&mut canvas);
        self.activity_chart.push(active.into(), ActivityChart::most_bars(layout));
        self.activity_chart.draw(&mut canvas, layout, camera.regions().into());
        canvas
    }
}

/// Draws every pixel in the colour that `colour_of` returns for its grey level and its region.
fn draw_pixels(
    canvas: &mut PictureCanvas,
    shown: &OverlayFrame<'_>,
    layout: PictureLayout,
    colour_of: impl Fn(u8, usize) -> Colour,
) {
    let OverlayFrame { camera, frame, .. } = *shown;
    let (side, scale) = (camera.region_size(), layout.scale);
    for y in 0..frame.height() {
        for x in 0..frame.width() {
            let region = y / side * camera.columns() + x / side;
            let grey = to_byte(convert_depth(frame.get(x, y), frame.bits(), 8));
            let colour = colour_of(grey, region as usize);
            canvas.fill_rectangle(x * scale, y * scale, scale, scale, colour);
        }
    }
}

fn region_areas(
    camera: &Camera,
    layout: PictureLayout,
) -> impl Iterator<Item = (usize, [u32; 4])> + use<> {
    let (cell, columns) = (camera.region_size() * layout.scale, camera.columns());
    (0..camera.regions()).map(move |region| {
        (region as usize, layout.region_area(cell, (region % columns, region / columns)))
    })
}

fn draw_sent(canvas: &mut PictureCanvas, shown: &OverlayFrame<'_>, layout: PictureLayout) {
    let OverlayFrame { camera, outcome, .. } = *shown;
    draw_pixels(canvas, shown, layout, |grey, region| shade(grey, outcome.actions[region]));
    if camera.region_size() * layout.scale < SMALLEST_GRID {
        return;
    }
    for (region, area) in region_areas(camera, layout) {
        if outcome.actions[region] == RegionAction::Summarize {
            canvas.draw_border(area, 1, mix(MEANS.0, TEXT, 0.5));
        }
    }
}

fn shade(grey: u8, action: RegionAction) -> Colour {
    match action {
        RegionAction::Forward => [grey; 3],
        RegionAction::Summarize => mix([grey; 3], MEANS.0, MEANS.1),
        RegionAction::Hold | RegionAction::Blank => mix([0; 3], [grey; 3], DARK),
    }
}

fn draw_outlines(canvas: &mut PictureCanvas, shown: &OverlayFrame<'_>, layout: PictureLayout) {
    let OverlayFrame { camera, outcome, .. } = *shown;
    draw_pixels(canvas, shown, layout, |grey, region| {
        tinted(grey.into(), region_tint(outcome, region))
    });
    let cell = camera.region_size() * layout.scale;
    if cell < SMALLEST_GRID {
        return;
    }
    for (region, area) in region_areas(camera, layout) {
        let [left, top, width, height] = area;
        lighten_line(canvas, [left, top, width, 1]);
        lighten_line(canvas, [left, top, 1, height]);
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

/// Returns the keys of the legend. `active` is the number of regions that are sent.
fn legend_keys(camera: &Camera, style: OverlayStyle, active: u32) -> Vec<LegendKey> {
    let regions = u64::from(camera.regions());
    let permille = (u64::from(active) * 1000 + regions / 2) / regions;
    let share = format!("sent: {}.{} %", permille / 10, permille % 10);
    let sent = |mark| LegendKey { mark, text: share.clone(), longest: "sent: 100.0 %".to_owned() };
    let mut keys = match style {
        OverlayStyle::Sent => vec![sent(SENT), LegendKey::new(NOT_SENT, "not sent")],
        OverlayStyle::Outlines => vec![
            sent(LegendMark::Filled(ACTIVE, ACTIVE_BRIGHT)),
            LegendKey::new(LegendMark::Filled(RELEVANT, RELEVANT), "relevant, unchanged"),
            LegendKey::new(LegendMark::Filled(CHANGED, CHANGED), "changed, irrelevant"),
        ],
    };
    if camera.periphery().is_some() {
        let mark = match style {
            OverlayStyle::Sent => LegendMark::Filled(MEANS.0, mix(MEANS.0, TEXT, 0.5)),
            OverlayStyle::Outlines => LegendMark::Border(TEXT),
        };
        keys.push(LegendKey::new(mark, "only averages sent"));
    }
    if camera.displacement_feature().is_some() {
        keys.push(LegendKey::new(LegendMark::Arrow(ARROW), "moved"));
    }
    keys.extend(ClassMarks::of_camera(camera).iter().flat_map(ClassMarks::legend_keys));
    keys
}

fn region_tint(outcome: &FrameOutcome, region: usize) -> Option<Colour> {
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
    use foveate_output::palette::vision::{VISIONS, distance};

    use super::*;

    /// Also in grey, where a border marks means: what is sent is brighter than what is not. Content darker
    /// than 48 of 255 looks nearly the same; outlines show it.
    #[test]
    fn what_is_sent_is_distinguishable_with_any_colour_vision() {
        use RegionAction::{Blank, Forward, Hold, Summarize};
        for (kind, vision) in VISIONS.into_iter().enumerate() {
            for grey in 48..=255 {
                let colour = |action| shade(grey, action);
                assert_eq!(colour(Hold), colour(Blank));
                let far = distance(colour(Forward), colour(Hold), vision);
                assert!(far > 20.0, "{kind} {grey} sent {far}");
                let far = distance(colour(Summarize), colour(Hold), vision);
                assert!(far > 15.0, "{kind} {grey} means {far}");
            }
        }
    }

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
