// SPDX-License-Identifier: MIT OR Apache-2.0
//! The drawing of a chart for every backend ([`draw`]): the series or groups of bars on their
//! axes, the legend on the right with the names of series and the look of each, and the caption
//! below. The names of groups are below their bars: horizontal if there is room, else vertical.

use super::chart_data::{
    BACKGROUND, DrawResult, GRID, INK, SECONDARY, SIZE, SeriesStyle, number_label, rgb,
    styled_lines, target_mark, truncated, unit_label,
};
use super::{BarSeries, Chart, ChartData, ChartSeries, LineLook};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const CAPTION_HEIGHT: u32 = 24;
/// The number of points above which a line has no dots.
const MAX_POINTS_WITH_DOTS: usize = 40;

pub(crate) fn draw<DB: DrawingBackend>(
    chart: &Chart,
    root: &DrawingArea<DB, Shift>,
) -> DrawResult<DB> {
    root.fill(&BACKGROUND)?;
    let (above, caption) = root.split_vertically(SIZE.1 - CAPTION_HEIGHT);
    let (plot, legend) = above.split_horizontally(SIZE.0 - LEGEND_WIDTH);
    let small = ("sans-serif", 11).into_font().color(&SECONDARY);
    caption.draw(&Text::new(chart.caption.clone(), (12, 4), small))?;
    match &chart.shape {
        ChartData::Lines(lines) => {
            let mut context = draw_linear_axes(chart, lines, &plot)?;
            draw_series(lines, &mut context)?;
            draw_line_names::<DB>(lines, &legend)?;
        }
        ChartData::Points(points) => {
            let mut context = draw_linear_axes(chart, points, &plot)?;
            draw_points(points, &mut context)?;
            draw_point_names::<DB>(points, &legend)?;
        }
        ChartData::LogLines(lines) => {
            draw_log_lines::<DB>(chart, lines, &plot)?;
            draw_line_names::<DB>(lines, &legend)?;
        }
        ChartData::Bars { groups, series } => {
            draw_bars::<DB>(chart, groups, series, &plot)?;
            draw_bar_names::<DB>(series, &legend)?;
        }
    }
    root.present()
}

fn draw_log_lines<DB: DrawingBackend>(
    chart: &Chart,
    lines: &[ChartSeries],
    area: &DrawingArea<DB, Shift>,
) -> DrawResult<DB> {
    let points = || lines.iter().flat_map(|line| line.points.iter().copied());
    let first = points().map(|point| point.0).fold(f64::INFINITY, f64::min);
    let last = points().map(|point| point.0).fold(0.0, f64::max);
    let (first, last) = if first < last { (first, last) } else { (1.0, 10.0) };
    let height = axis_top(points().map(|point| point.1));
    let across = (0.8 * first..1.25 * last).log_scale();
    let mut context = line_chart_builder(chart, area).build_cartesian_2d(across, 0.0..height)?;
    draw_grid(chart, &mut context, MAX_LABELS, &|&x| unit_label(x))?;
    draw_series(lines, &mut context)
}

fn draw_series<DB: DrawingBackend, X: Ranged<ValueType = f64>>(
    lines: &[ChartSeries],
    context: &mut AxesContext<'_, DB, X>,
) -> DrawResult<DB> {
    for (SeriesStyle { colour, is_open }, line) in styled_lines(lines) {
        if line.look == LineLook::Target {
            continue;
        }
        let (points, is_long) =
            (line.points.iter().copied(), line.points.len() > MAX_POINTS_WITH_DOTS);
        let style = colour.stroke_width(2);
        let dashes = |ends: &[(f64, f64)], style| {
            DashedLineSeries::new(ends.to_vec(), 6, 4, style).into_iter()
        };
        // Each segment is drawn separately, because a thick line that is drawn as a whole gets a
        // spike across the page at a sharp corner. An open line whose points lie close together is
        // nevertheless drawn as a whole, because its segments are too short for gaps. It is thin.
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
    let targets = lines.iter().filter(|line| line.look == LineLook::Target);
    context
        .draw_series(targets.flat_map(|line| line.points.iter().copied().flat_map(target_mark)))?;
    Ok(())
}

fn draw_points<DB: DrawingBackend>(
    series: &[ChartSeries],
    context: &mut AxesContext<'_, DB, RangedCoordf64>,
) -> DrawResult<DB> {
    for (style, line) in styled_lines(series) {
        let dot = |&point: &(f64, f64)| Circle::new(point, 3, style.colour.filled());
        context.draw_series(line.points.iter().map(dot))?;
    }
    Ok(())
}

/// The margin around the plot in pixels.
const MARGIN: u32 = 12;
/// The width of the vertical axis with its labels in pixels.
const AXIS_WIDTH: u32 = 64;
/// The distance from the axis to the names in pixels.
const NAME_GAP: u32 = 8;
/// The height of the axis title below the names in pixels.
const TITLE_HEIGHT: u32 = 28;
/// The smallest distance between two horizontal names in pixels.
const MIN_NAME_DISTANCE: u32 = 10;
/// The most letters of a name, because names of clips may be long.
const MAX_NAME_LETTERS: usize = 20;

pub(crate) fn draw_bars<DB: DrawingBackend>(
    chart: &Chart,
    groups: &[String],
    series: &[BarSeries],
    area: &DrawingArea<DB, Shift>,
) -> DrawResult<DB> {
    let number = |count: usize| f64::from(u32::try_from(count).expect("bars are few"));
    let upper_ends = series.iter().flat_map(|bars| {
        bars.values.iter().copied().chain(bars.ranges.iter().map(|range| range.1))
    });
    let names: Vec<String> = groups.iter().map(|name| truncated(name, MAX_NAME_LETTERS)).collect();
    let style = ("sans-serif", 13).into_font().color(&INK);
    let (mut widest, mut tallest) = (0, 0);
    for name in &names {
        let (width, height) = area.estimate_text_size(name, &style)?;
        (widest, tallest) = (widest.max(width), tallest.max(height));
    }
    let (width, height) = area.dim_in_pixel();
    let width_per_group = width.saturating_sub(2 * MARGIN + AXIS_WIDTH)
        / u32::try_from(names.len().max(1)).unwrap_or(u32::MAX);
    let is_horizontal = widest + MIN_NAME_DISTANCE <= width_per_group;
    let mut context = ChartBuilder::on(area)
        .caption(&chart.title, ("sans-serif", 20))
        .margin(MARGIN)
        .x_label_area_size(NAME_GAP + TITLE_HEIGHT + if is_horizontal { tallest } else { widest })
        .y_label_area_size(AXIS_WIDTH)
        .build_cartesian_2d(0.0..number(groups.len().max(1)), 0.0..axis_top(upper_ends))?;
    context
        .configure_mesh()
        .disable_x_mesh()
        .x_labels(0)
        .y_label_formatter(&|&y| number_label(y))
        .y_desc(&chart.y_title)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 15))
        .light_line_style(BACKGROUND)
        .bold_line_style(GRID)
        .draw()?;
    let bar_width = 0.8 / number(series.len().max(1));
    for (at, bars) in series.iter().enumerate() {
        let left = |group: usize| number(group) + 0.1 + bar_width * number(at);
        let bar = |(group, &value): (usize, &f64)| {
            let corners = [(left(group), 0.0), (left(group) + 0.9 * bar_width, value)];
            Rectangle::new(corners, rgb(bars.colour).filled())
        };
        context.draw_series(bars.values.iter().enumerate().map(bar))?;
        let whisker = |(group, &(from, to)): (usize, &(f64, f64))| {
            let middle = left(group) + 0.45 * bar_width;
            PathElement::new(vec![(middle, from), (middle, to)], INK.stroke_width(2))
        };
        context.draw_series(bars.ranges.iter().enumerate().map(whisker))?;
    }
    let style = if is_horizontal {
        style.pos(Pos::new(HPos::Center, VPos::Top))
    } else {
        // Vertical names end below their group.
        style.transform(FontTransform::Rotate270).pos(Pos::new(HPos::Right, VPos::Center))
    };
    let [above, middle, bottom] =
        [NAME_GAP, width / 2, height].map(|at| i32::try_from(at).expect("within SIZE"));
    for (group, name) in names.into_iter().enumerate() {
        let (x, y) = context.backend_coord(&(number(group) + 0.5, 0.0));
        let (x0, y0) = area.get_base_pixel();
        area.draw(&Text::new(name, (x - x0, y - y0 + above), style.clone()))?;
    }
    let axis = ("sans-serif", 15).into_font().color(&INK).pos(Pos::new(HPos::Center, VPos::Bottom));
    area.draw(&Text::new(chart.x_title.clone(), (middle, bottom - 2), axis))
}

/// The width of the legend in pixels.
pub(crate) const LEGEND_WIDTH: u32 = 210;
const LEGEND_MAX_NAME_LETTERS: usize = 25;

/// Returns the vertical positions of the rows of a legend in pixels.
fn row_heights() -> impl Iterator<Item = i32> {
    (56..).step_by(22)
}

pub(crate) fn draw_bar_names<DB: DrawingBackend>(
    series: &[BarSeries],
    area: &DrawingArea<DB, Shift>,
) -> DrawResult<DB> {
    for (bars, y) in series.iter().zip(row_heights()) {
        area.draw(&Rectangle::new([(4, y - 6), (18, y + 6)], rgb(bars.colour).filled()))?;
        draw_name::<DB>(&bars.name, y, area)?;
    }
    Ok(())
}

pub(crate) fn draw_line_names<DB: DrawingBackend>(
    lines: &[ChartSeries],
    area: &DrawingArea<DB, Shift>,
) -> DrawResult<DB> {
    for ((style, line), y) in styled_lines(lines).zip(row_heights()) {
        draw_name::<DB>(&line.name, y, area)?;
        if line.look == LineLook::Target {
            target_mark((13, y)).into_iter().try_for_each(|part| area.draw(&part))?;
            continue;
        }
        let pieces: &[(i32, i32)] = if style.is_open { &[(4, 11), (16, 23)] } else { &[(4, 23)] };
        for &(from, to) in pieces {
            let stroke = style.colour.stroke_width(3);
            area.draw(&PathElement::new(vec![(from, y), (to, y)], stroke))?;
        }
    }
    Ok(())
}

pub(crate) fn draw_point_names<DB: DrawingBackend>(
    series: &[ChartSeries],
    area: &DrawingArea<DB, Shift>,
) -> DrawResult<DB> {
    for ((style, line), y) in styled_lines(series).zip(row_heights()) {
        area.draw(&Circle::new((13, y), 4, style.colour.filled()))?;
        draw_name::<DB>(&line.name, y, area)?;
    }
    Ok(())
}

fn draw_name<DB: DrawingBackend>(
    name: &str,
    y: i32,
    area: &DrawingArea<DB, Shift>,
) -> DrawResult<DB> {
    let font = ("sans-serif", 13).into_font().color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
    area.draw(&Text::new(truncated(name, LEGEND_MAX_NAME_LETTERS), (29, y), font))
}

/// The most labels of a horizontal axis.
pub(crate) const MAX_LABELS: u8 = 11;

/// A plot with its axes, which series are drawn into.
pub(crate) type AxesContext<'a, DB, X> = ChartContext<'a, DB, Cartesian2d<X, RangedCoordf64>>;

/// Returns the upper end of an axis: a little more than the largest value, so that no line touches
/// the frame.
pub(crate) fn axis_top(values: impl Iterator<Item = f64>) -> f64 {
    let largest = values.fold(0.0, f64::max);
    if largest > 0.0 { 1.05 * largest } else { 1.0 }
}

/// Returns the builder of a chart of lines, before its axes are set.
pub(crate) fn line_chart_builder<'a, DB: DrawingBackend>(
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

/// Draws axes from 0 to the largest value.
pub(crate) fn draw_linear_axes<'a, DB: DrawingBackend>(
    chart: &Chart,
    lines: &[ChartSeries],
    area: &'a DrawingArea<DB, Shift>,
) -> Result<AxesContext<'a, DB, RangedCoordf64>, DrawingAreaErrorKind<DB::ErrorType>> {
    let points = || lines.iter().flat_map(|line| line.points.iter().copied());
    let last = points().map(|point| point.0).fold(0.0, f64::max);
    let last = if last > 0.0 { last } else { 1.0 };
    let height = axis_top(points().map(|point| point.1));
    let mut context = line_chart_builder(chart, area).build_cartesian_2d(0.0..last, 0.0..height)?;
    // If every horizontal value is a whole number, each whole number has at most one label.
    let label_count = points().all(|(x, _)| x.fract() == 0.0).then(|| whole_labels(last));
    draw_grid(chart, &mut context, label_count.unwrap_or(MAX_LABELS), &|&x| number_label(x))?;
    Ok(context)
}

/// Returns the number of labels from 0 to `last`, at most one for each whole number.
fn whole_labels(last: f64) -> u8 {
    let positive_labels = (1..MAX_LABELS).take_while(|&label| f64::from(label) <= last);
    positive_labels.last().unwrap_or(0) + 1
}

pub(crate) fn draw_grid<DB: DrawingBackend, X: Ranged<ValueType = f64> + ValueFormatter<f64>>(
    chart: &Chart,
    context: &mut AxesContext<'_, DB, X>,
    labels: u8,
    label: &dyn Fn(&f64) -> String,
) -> DrawResult<DB> {
    context
        .configure_mesh()
        .x_labels(labels.into())
        .x_label_formatter(&label)
        .y_label_formatter(&|&y| number_label(y))
        .x_desc(&chart.x_title)
        .y_desc(&chart.y_title)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 15))
        .light_line_style(BACKGROUND)
        .bold_line_style(GRID)
        .draw()
}
