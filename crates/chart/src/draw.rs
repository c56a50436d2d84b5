// SPDX-License-Identifier: MIT OR Apache-2.0
//! One drawing for every backend: axes, series, legend beside them, caption below.

use foveate_palette::{Colour, LIGHT};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::chart::SIZE;
use crate::{Bars, Chart, Line, Shape};

/// Columns of pixels for the legend, and letters of a name in it.
const LEGEND: u32 = 210;
const LETTERS: usize = 25;
const CAPTION: u32 = 24;
const GROUND: RGBColor = rgb(LIGHT.ground);
const INK: RGBColor = rgb(LIGHT.ink);
const QUIET: RGBColor = rgb(LIGHT.quiet);
const GRID: RGBColor = rgb(LIGHT.grid);
/// With more points than this a line has no dots.
const DOTS: usize = 40;

type Result<DB> = std::result::Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

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
            draw_names_of_lines::<DB>(lines, &legend)?;
        }
        Shape::Points(points) => {
            let mut context = plain_axes(chart, points, &plot)?;
            draw_points(points, &mut context)?;
            draw_names_of_points::<DB>(points, &legend)?;
        }
        Shape::LogLines(lines) => {
            draw_log_lines::<DB>(chart, lines, &plot)?;
            draw_names_of_lines::<DB>(lines, &legend)?;
        }
        Shape::Bars { groups, series } => {
            draw_bars::<DB>(chart, groups, series, &plot)?;
            draw_names_of_bars::<DB>(series, &legend)?;
        }
    }
    root.present()
}

/// Of a line by its number.
fn colour(number: usize) -> RGBColor {
    rgb(LIGHT.series[number % LIGHT.series.len()])
}

const fn rgb([red, green, blue]: Colour) -> RGBColor {
    RGBColor(red, green, blue)
}

fn dashed(number: usize) -> bool {
    number >= LIGHT.series.len()
}

/// A little more than the largest, so that nothing touches the frame.
fn top(values: impl Iterator<Item = f64>) -> f64 {
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
    draw_mesh(chart, &mut context, None)?;
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
    draw_mesh(chart, &mut context, Some(&|&x| thousands(x)))?;
    draw_series(lines, &mut context)
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
    label: Option<&dyn Fn(&f64) -> String>,
) -> Result<DB> {
    let mut mesh = context.configure_mesh();
    if let Some(label) = &label {
        mesh.x_label_formatter(label);
    }
    mesh.x_desc(&chart.x)
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
    for (number, line) in lines.iter().enumerate() {
        let points = line.points.iter().copied();
        if dashed(number) {
            let style = colour(number).stroke_width(1);
            context.draw_series(DashedLineSeries::new(points.clone(), 6, 4, style))?;
        } else {
            // Piece by piece: at a sharp corner a thick line as a whole gets a spike across the page.
            let style = colour(number).stroke_width(2);
            let piece = |ends: &[(f64, f64)]| PathElement::new(ends.to_vec(), style);
            context.draw_series(line.points.windows(2).map(piece))?;
        }
        if line.points.len() <= DOTS {
            let dot = |point| Circle::new(point, 3, colour(number).filled());
            context.draw_series(points.map(dot))?;
        }
    }
    Ok(())
}

fn draw_points<DB: DrawingBackend>(
    series: &[Line],
    context: &mut Plot<'_, DB, RangedCoordf64>,
) -> Result<DB> {
    for (number, points) in series.iter().enumerate() {
        let dot = |&point: &(f64, f64)| Circle::new(point, 3, colour(number).filled());
        context.draw_series(points.points.iter().map(dot))?;
    }
    Ok(())
}

fn draw_bars<DB: DrawingBackend>(
    chart: &Chart,
    groups: &[String],
    series: &[Bars],
    area: &DrawingArea<DB, Shift>,
) -> Result<DB> {
    let number = |count: usize| f64::from(u32::try_from(count).expect("bars are few"));
    let tops = series.iter().flat_map(|bars| {
        bars.values.iter().copied().chain(bars.ranges.iter().map(|range| range.1))
    });
    let mut context = ChartBuilder::on(area)
        .caption(&chart.title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(168)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..number(groups.len().max(1)), 0.0..top(tops))?;
    context
        .configure_mesh()
        .disable_x_mesh()
        .x_labels(0)
        .y_desc(&chart.y)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 15))
        .light_line_style(GROUND)
        .bold_line_style(GRID)
        .draw()?;
    let wide = 0.8 / number(series.len().max(1));
    for (at, bars) in series.iter().enumerate() {
        let left = |group: usize| number(group) + 0.1 + wide * number(at);
        let bar = |(group, &value): (usize, &f64)| {
            let corners = [(left(group), 0.0), (left(group) + 0.9 * wide, value)];
            Rectangle::new(corners, rgb(bars.colour).filled())
        };
        context.draw_series(bars.values.iter().enumerate().map(bar))?;
        let whisker = |(group, &(from, to)): (usize, &(f64, f64))| {
            let middle = left(group) + 0.45 * wide;
            PathElement::new(vec![(middle, from), (middle, to)], INK.stroke_width(2))
        };
        context.draw_series(bars.ranges.iter().enumerate().map(whisker))?;
    }
    // Names of clips are long: they are written upwards, ending below their group.
    let style = ("sans-serif", 13)
        .into_font()
        .transform(FontTransform::Rotate270)
        .color(&INK)
        .pos(Pos::new(HPos::Right, VPos::Center));
    for (group, name) in groups.iter().enumerate() {
        let (x, y) = context.backend_coord(&(number(group) + 0.5, 0.0));
        let (x0, y0) = (area.get_base_pixel().0, area.get_base_pixel().1);
        area.draw(&Text::new(cut(name, 20), (x - x0, y - y0 + 8), style.clone()))?;
    }
    let (width, height) = area.dim_in_pixel();
    let axis = ("sans-serif", 15).into_font().color(&INK).pos(Pos::new(HPos::Center, VPos::Bottom));
    let [middle, bottom] = [width / 2, height].map(|at| i32::try_from(at).expect("within SIZE"));
    let below = (middle, bottom - 2);
    area.draw(&Text::new(chart.x.clone(), below, axis))
}

/// Heights of the rows of a legend.
fn rows() -> impl Iterator<Item = i32> {
    (56..).step_by(22)
}

fn draw_names_of_bars<DB: DrawingBackend>(
    series: &[Bars],
    area: &DrawingArea<DB, Shift>,
) -> Result<DB> {
    for (bars, y) in series.iter().zip(rows()) {
        area.draw(&Rectangle::new([(4, y - 6), (18, y + 6)], rgb(bars.colour).filled()))?;
        draw_name::<DB>(&bars.name, y, area)?;
    }
    Ok(())
}

fn draw_names_of_lines<DB: DrawingBackend>(
    lines: &[Line],
    area: &DrawingArea<DB, Shift>,
) -> Result<DB> {
    for (number, (line, y)) in lines.iter().zip(rows()).enumerate() {
        let pieces: &[(i32, i32)] = if dashed(number) { &[(4, 11), (16, 23)] } else { &[(4, 23)] };
        for &(from, to) in pieces {
            let style = colour(number).stroke_width(3);
            area.draw(&PathElement::new(vec![(from, y), (to, y)], style))?;
        }
        draw_name::<DB>(&line.name, y, area)?;
    }
    Ok(())
}

fn draw_names_of_points<DB: DrawingBackend>(
    series: &[Line],
    area: &DrawingArea<DB, Shift>,
) -> Result<DB> {
    for (number, (points, y)) in series.iter().zip(rows()).enumerate() {
        area.draw(&Circle::new((13, y), 4, colour(number).filled()))?;
        draw_name::<DB>(&points.name, y, area)?;
    }
    Ok(())
}

fn draw_name<DB: DrawingBackend>(name: &str, y: i32, area: &DrawingArea<DB, Shift>) -> Result<DB> {
    let font = ("sans-serif", 13).into_font().color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
    area.draw(&Text::new(cut(name, LETTERS), (29, y), font))
}

fn cut(name: &str, letters: usize) -> String {
    if name.chars().count() <= letters {
        return name.to_owned();
    }
    name.chars().take(letters - 1).chain(['…']).collect()
}
