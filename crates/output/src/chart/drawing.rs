// SPDX-License-Identifier: MIT OR Apache-2.0
//! Draws a chart for every backend: the series on their axes, the legend on the right, and the
//! caption below.

use plotters::coord::Shift;
use plotters::coord::ranged1d::Ranged;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::axes::{
    AxesContext, MAX_LABELS, axis_top, draw_grid, draw_linear_axes, line_chart_builder,
};
use super::bars::draw_bars;
use super::chart_data::SIZE;
use super::label::unit_label;
use super::legend::{LEGEND_WIDTH, draw_bar_names, draw_line_names, draw_point_names};
use super::series_style::{
    BACKGROUND, DrawResult, SECONDARY, SeriesStyle, styled_lines, target_mark,
};
use super::{Chart, ChartData, ChartSeries, LineLook};

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
