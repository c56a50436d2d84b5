// SPDX-License-Identifier: MIT OR Apache-2.0
//! One drawing for every backend: axes, series, legend beside them, caption below.

use crate::palette::{Colour, LIGHT};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::bars::draw_bars;
use super::figure::SIZE;
use super::legend::{LEGEND, names_of_bars, names_of_lines, names_of_points};
use super::{Chart, Line, Look, Shape};

const CAPTION: u32 = 24;
pub(crate) const GROUND: RGBColor = rgb(LIGHT.ground);
pub(crate) const INK: RGBColor = rgb(LIGHT.ink);
const QUIET: RGBColor = rgb(LIGHT.quiet);
pub(crate) const GRID: RGBColor = rgb(LIGHT.grid);
/// With more points than this a line has no dots.
const DOTS: usize = 40;
/// The most labels of an axis across.
const LABELS: u8 = 11;

pub(crate) type Result<DB> =
    std::result::Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

pub(crate) fn draw<DB: DrawingBackend>(chart: &Chart, root: &DrawingArea<DB, Shift>) -> Result<DB> {
    root.fill(&GROUND)?;
    let (above, caption) = root.split_vertically(SIZE.1 - CAPTION);
    let (plot, legend) = above.split_horizontally(SIZE.0 - LEGEND);
    let small = ("sans-serif", 11).into_font().color(&QUIET);
    caption.draw(&Text::new(chart.caption.clone(), (12, 4), small))?;
    match &chart.shape {
        Shape::Lines(lines) => {
            let mut context = plain_axes(chart, lines, &plot)?;
            draw_series(lines, &mut context)?;
            names_of_lines::<DB>(lines, &legend)?;
        }
        Shape::Points(points) => {
            let mut context = plain_axes(chart, points, &plot)?;
            draw_points(points, &mut context)?;
            names_of_points::<DB>(points, &legend)?;
        }
        Shape::LogLines(lines) => {
            draw_log_lines::<DB>(chart, lines, &plot)?;
            names_of_lines::<DB>(lines, &legend)?;
        }
        Shape::Bars { groups, series } => {
            draw_bars::<DB>(chart, groups, series, &plot)?;
            names_of_bars::<DB>(series, &legend)?;
        }
    }
    root.present()
}

/// How a line is told from the others.
#[derive(Clone, Copy)]
pub(crate) struct Numbered {
    pub(crate) colour: RGBColor,
    /// Whether a line below shows through it.
    pub(crate) is_open: bool,
}

/// Lines with their colours, of which a target needs none. When all are taken, they are drawn with gaps from the first on.
pub(crate) fn numbered(lines: &[Line]) -> impl Iterator<Item = (Numbered, &Line)> {
    let colours = LIGHT.series.len();
    let mut next = 0;
    lines.iter().map(move |line| {
        if line.look == Look::Target {
            return (Numbered { colour: INK, is_open: false }, line);
        }
        let number = next;
        next += 1;
        let colour = rgb(LIGHT.series[number % colours]);
        (Numbered { colour, is_open: line.look == Look::Open || number >= colours }, line)
    })
}

/// A disc that nothing hides, with a ring and a dot.
pub(crate) fn target<C: Clone>(at: C) -> [Circle<C, u32>; 3] {
    [
        Circle::new(at.clone(), 9, GROUND.filled()),
        Circle::new(at.clone(), 7, INK.stroke_width(2)),
        Circle::new(at, 3, INK.filled()),
    ]
}

pub(crate) const fn rgb([red, green, blue]: Colour) -> RGBColor {
    RGBColor(red, green, blue)
}

/// A little more than the largest, so that nothing touches the frame.
pub(crate) fn top(values: impl Iterator<Item = f64>) -> f64 {
    let largest = values.fold(0.0, f64::max);
    if largest > 0.0 { 1.05 * largest } else { 1.0 }
}

/// A drawing of lines up to its axes.
fn lines_on<'a, DB: DrawingBackend>(
    chart: &Chart,
    area: &'a DrawingArea<DB, Shift>,
) -> ChartBuilder<'a, 'a, DB> {
    let mut builder = ChartBuilder::on(area);
    builder
        .caption(&chart.title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64);
    builder
}

/// Axes from 0 to the largest.
fn plain_axes<'a, DB: DrawingBackend>(
    chart: &Chart,
    lines: &[Line],
    area: &'a DrawingArea<DB, Shift>,
) -> std::result::Result<Plot<'a, DB, RangedCoordf64>, DrawingAreaErrorKind<DB::ErrorType>> {
    let points = || lines.iter().flat_map(|line| line.points.iter().copied());
    let last = points().map(|point| point.0).fold(0.0, f64::max);
    let last = if last > 0.0 { last } else { 1.0 };
    let height = top(points().map(|point| point.1));
    let mut context = lines_on(chart, area).build_cartesian_2d(0.0..last, 0.0..height)?;
    // Where every value is whole, every label is: no more labels than whole numbers.
    let whole = points().all(|(x, _)| x.fract() == 0.0).then(|| whole_labels(last));
    draw_mesh(chart, &mut context, whole.unwrap_or(LABELS), &|&x| plain(x))?;
    Ok(context)
}

fn draw_log_lines<DB: DrawingBackend>(
    chart: &Chart,
    lines: &[Line],
    area: &DrawingArea<DB, Shift>,
) -> Result<DB> {
    let points = || lines.iter().flat_map(|line| line.points.iter().copied());
    let first = points().map(|point| point.0).fold(f64::INFINITY, f64::min);
    let last = points().map(|point| point.0).fold(0.0, f64::max);
    let (first, last) = if first < last { (first, last) } else { (1.0, 10.0) };
    let height = top(points().map(|point| point.1));
    let across = (0.8 * first..1.25 * last).log_scale();
    let mut context = lines_on(chart, area).build_cartesian_2d(across, 0.0..height)?;
    draw_mesh(chart, &mut context, LABELS, &|&x| thousands(x))?;
    draw_series(lines, &mut context)
}

/// Labels from 0 to this number, at most one for each whole number.
fn whole_labels(last: f64) -> u8 {
    let more = (1..LABELS).take_while(|&label| f64::from(label) <= last);
    more.last().unwrap_or(0) + 1
}

/// A label with no more digits than it needs.
pub(crate) fn plain(value: f64) -> String {
    // Steps of an axis are added up.
    ((value * 1e9).round() / 1e9).to_string()
}

/// A label of a logarithmic axis, such as `20 k`.
fn thousands(value: f64) -> String {
    let units = [(1e9, " G"), (1e6, " M"), (1e3, " k")];
    let unit = units.into_iter().find(|&(size, _)| value >= size).unwrap_or((1.0, ""));
    format!("{}{}", (value / unit.0 * 10.0).round() / 10.0, unit.1)
}

type Plot<'a, DB, X> = ChartContext<'a, DB, Cartesian2d<X, RangedCoordf64>>;

fn draw_mesh<DB: DrawingBackend, X: Ranged<ValueType = f64> + ValueFormatter<f64>>(
    chart: &Chart,
    context: &mut Plot<'_, DB, X>,
    labels: u8,
    label: &dyn Fn(&f64) -> String,
) -> Result<DB> {
    context
        .configure_mesh()
        .x_labels(labels.into())
        .x_label_formatter(&label)
        .y_label_formatter(&|&y| plain(y))
        .x_desc(&chart.x)
        .y_desc(&chart.y)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 15))
        .light_line_style(GROUND)
        .bold_line_style(GRID)
        .draw()
}

fn draw_series<DB: DrawingBackend, X: Ranged<ValueType = f64>>(
    lines: &[Line],
    context: &mut Plot<'_, DB, X>,
) -> Result<DB> {
    for (Numbered { colour, is_open }, line) in numbered(lines) {
        if line.look == Look::Target {
            continue;
        }
        let (points, is_long) = (line.points.iter().copied(), line.points.len() > DOTS);
        let style = colour.stroke_width(2);
        let dashes = |ends: &[(f64, f64)], style| {
            DashedLineSeries::new(ends.to_vec(), 6, 4, style).into_iter()
        };
        // Piece by piece: at a sharp corner a thick line as a whole gets a spike across the page. A gap between points that lie
        // close together needs the line as a whole.
        match (is_open, is_long) {
            (true, true) => context.draw_series(dashes(&line.points, colour.stroke_width(1)))?,
            (true, false) => {
                context.draw_series(line.points.windows(2).flat_map(|ends| dashes(ends, style)))?
            }
            (false, _) => {
                let piece = |ends: &[(f64, f64)]| PathElement::new(ends.to_vec(), style);
                context.draw_series(line.points.windows(2).map(piece))?
            }
        };
        if !is_long {
            let dot = |point| match is_open {
                true => Circle::new(point, 5, style),
                false => Circle::new(point, 3, colour.filled()),
            };
            context.draw_series(points.map(dot))?;
        }
    }
    let targets = lines.iter().filter(|line| line.look == Look::Target);
    context.draw_series(targets.flat_map(|line| line.points.iter().copied().flat_map(target)))?;
    Ok(())
}

fn draw_points<DB: DrawingBackend>(
    series: &[Line],
    context: &mut Plot<'_, DB, RangedCoordf64>,
) -> Result<DB> {
    for (number, points) in numbered(series) {
        let dot = |&point: &(f64, f64)| Circle::new(point, 3, number.colour.filled());
        context.draw_series(points.points.iter().map(dot))?;
    }
    Ok(())
}

pub(crate) fn cut(name: &str, letters: usize) -> String {
    if name.chars().count() <= letters {
        return name.to_owned();
    }
    name.chars().take(letters - 1).chain(['…']).collect()
}
