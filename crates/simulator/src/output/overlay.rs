// SPDX-License-Identifier: MIT OR Apache-2.0
//! The overlay: the original frame with what is sent of it. Below it are a legend and the share of sent
//! regions over time.
//!
//! In the usual style the regions that are sent are bright, those of which only means are sent are
//! tinted and have a thin border, and all others are dark: as on the live page. In the style with
//! outlines the frame is dimmed, and the colour of a region says which of its two conditions holds. An
//! arrow shows the displacement of a region, bright if `flow` votes for the region and faint otherwise.
//! Without scores it is bright if the region is relevant.
//!
//! Regions that are off are hatched, and a line in the colour of the class surrounds the areas of
//! regions that are keen or always relevant. The legend has as many lines as it needs.

use super::OverlayStyle;
use super::activity_chart::ActivityChart;
use super::arrow::Arrow;
use super::canvas::{
    BACKGROUND, LINE_DOTS, PictureCanvas, PictureLayout, TEXT, TEXT_DOTS, mix, text_width,
};
use super::picture_series::PicturePainter;
use super::raw_image::to_byte;
use super::sink::SinkFrame;
use foveate_camera::{Camera, Displacement, RegionAction, RegionClass};
use foveate_engine::FrameOutcome;
use foveate_output::palette::{ACTIVE, ACTIVE_BRIGHT, CHANGED, Colour, RELEVANT, SERIES};
use foveate_pixels::{ByteFrame, convert_depth};

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

/// The classes of the regions of a camera, with at least one that is not normal.
pub(super) struct ClassMarks<'a> {
    classes: &'a [RegionClass],
    columns: u32,
    rows: u32,
}

impl<'a> ClassMarks<'a> {
    /// Returns the marks of the map in a camera's configuration, or `None` if all of its regions are
    /// normal.
    pub(super) fn of_camera(camera: &'a Camera) -> Option<Self> {
        let classes = camera.zones()?.configured_classes();
        let is_marked = classes.iter().any(|&class| class != RegionClass::Normal);
        is_marked.then(|| Self { classes, columns: camera.columns(), rows: camera.rows() })
    }

    /// Draws the marks on the picture of a frame.
    pub(super) fn draw(&self, canvas: &mut PictureCanvas, cell: u32, layout: PictureLayout) {
        for (region, &class) in (0..).zip(self.classes) {
            let place = (region % self.columns, region / self.columns);
            let area = layout.region_area(cell, place);
            match class {
                RegionClass::Normal => {}
                RegionClass::Off => canvas.hatch(area, layout.dot),
                RegionClass::Keen | RegionClass::Always => {
                    self.draw_edges(canvas, place, area, layout.dot);
                }
            }
        }
    }

    /// Returns the keys of the classes that the map has.
    pub(super) fn legend_keys(&self) -> Vec<LegendKey> {
        let marked = RegionClass::ALL.iter().filter(|class| self.classes.contains(class));
        let key = |&class| {
            let mark = match class_colour(class) {
                Some(colour) => LegendMark::Border(colour),
                None if class == RegionClass::Off => LegendMark::Hatched,
                None => return None,
            };
            Some(LegendKey::new(mark, &format!("zone: {}", class.name())))
        };
        marked.filter_map(key).collect()
    }

    /// Draws a line on the sides of a region beyond which another class begins.
    fn draw_edges(
        &self,
        canvas: &mut PictureCanvas,
        (column, row): (u32, u32),
        [left, top, width, height]: [u32; 4],
        dot: u32,
    ) {
        let own = self.class_at(column, row);
        let colour = own.and_then(class_colour).unwrap_or(BACKGROUND);
        let line = dot.min(width).min(height);
        let ends =
            |x: Option<u32>, y: Option<u32>| x.zip(y).and_then(|(x, y)| self.class_at(x, y)) != own;
        let mut draw = |is_edge: bool, [left, top, width, height]: [u32; 4]| {
            if is_edge {
                canvas.fill_rectangle(left, top, width, height, colour);
            }
        };
        let (x, y) = (Some(column), Some(row));
        draw(ends(column.checked_sub(1), y), [left, top, line, height]);
        draw(ends(column.checked_add(1), y), [left + width - line, top, line, height]);
        draw(ends(x, row.checked_sub(1)), [left, top, width, line]);
        draw(ends(x, row.checked_add(1)), [left, top + height - line, width, line]);
    }

    fn class_at(&self, column: u32, row: u32) -> Option<RegionClass> {
        let is_inside = column < self.columns && row < self.rows;
        is_inside.then(|| self.classes[(row * self.columns + column) as usize])
    }
}

/// Returns the colour of the line around regions of a class.
fn class_colour(class: RegionClass) -> Option<Colour> {
    match class {
        RegionClass::Keen => Some(SERIES[0]),
        RegionClass::Always => Some(SERIES[1]),
        RegionClass::Normal | RegionClass::Off => None,
    }
}

/// The space between two keys in dots.
const SPACE_DOTS: u32 = 4;

/// The mark of a key.
#[derive(Clone, Copy, Debug)]
pub(super) enum LegendMark {
    /// A square of a colour with a border of another one.
    Filled(Colour, Colour),
    /// The border of a square.
    Border(Colour),
    /// A hatched square.
    Hatched,
    Arrow(Colour),
}

/// A mark and what it means.
#[derive(Clone, Debug)]
pub(super) struct LegendKey {
    pub(super) mark: LegendMark,
    pub(super) text: String,
    /// The longest text that the key may have in another frame.
    pub(super) longest: String,
}

impl LegendKey {
    pub(super) fn new(mark: LegendMark, text: &str) -> Self {
        Self { mark, text: text.to_owned(), longest: text.to_owned() }
    }

    fn width(&self, dot: u32) -> u32 {
        text_width(&self.longest, dot) + (self.mark.width_dots() + 2) * dot
    }
}

impl LegendMark {
    fn width_dots(self) -> u32 {
        if matches!(self, Self::Arrow(_)) { 2 * TEXT_DOTS } else { TEXT_DOTS }
    }

    fn draw(self, canvas: &mut PictureCanvas, left: u32, top: u32, dot: u32) {
        let side = TEXT_DOTS * dot;
        let (area, line) = ([left, top, side, side], dot.div_ceil(2));
        match self {
            Self::Filled(colour, border) => {
                canvas.fill_rectangle(left, top, side, side, colour);
                canvas.draw_border(area, line, border);
            }
            Self::Border(colour) => canvas.draw_border(area, line, colour),
            Self::Hatched => {
                canvas.fill_rectangle(left, top, side, side, [128; 3]);
                canvas.hatch(area, dot);
            }
            Self::Arrow(colour) => {
                let [start, top, side] = [left, top, side].map(f64::from);
                let middle = top + side / 2.0;
                let (tail, tip) = ([start, middle], [start + 2.0 * side, middle]);
                Arrow { tail, tip, head_width: side }.draw(canvas, colour, 1.0);
            }
        }
    }
}

/// The keys of a picture, each with its place.
pub(super) struct Legend {
    keys: Vec<(LegendKey, u32, u32)>,
    dot: u32,
    pub(super) height: u32,
}

impl Legend {
    /// Places the keys below the frame of a picture.
    pub(super) fn new(keys: Vec<LegendKey>, layout: PictureLayout) -> Self {
        let dot = layout.dot;
        let (start, mut top) = (2 * dot, layout.frame_height + 2 * dot);
        let mut left = start;
        let mut placed = Vec::new();
        for key in keys {
            let width = key.width(dot);
            if left > start && left + width > layout.width {
                (left, top) = (start, top + LINE_DOTS * dot);
            }
            placed.push((key, left, top));
            left += width + SPACE_DOTS * dot;
        }
        let height = top + (LINE_DOTS - 2) * dot - layout.frame_height;
        Self { keys: placed, dot, height }
    }

    pub(super) fn draw(&self, canvas: &mut PictureCanvas) {
        let dot = self.dot;
        for &(LegendKey { mark, ref text, .. }, left, top) in &self.keys {
            mark.draw(canvas, left, top, dot);
            canvas.draw_text(left + (mark.width_dots() + 2) * dot, top, dot, text);
        }
    }
}

/// The marks of what is sent as a whole, and of what is not sent.
pub(super) const SENT: LegendMark = LegendMark::Filled([235; 3], TEXT);
pub(super) const NOT_SENT: LegendMark = LegendMark::Filled([48; 3], [120; 3]);

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_output::palette::vision::{VISIONS, distance};

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
