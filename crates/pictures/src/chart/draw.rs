// SPDX-License-Identifier: MIT OR Apache-2.0
//! Draws a chart for every backend: the series on their axes, the legend on the right, and the
//! caption below.

use plotters::coord::Shift;
use plotters::coord::ranged1d::Ranged;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::axes::{LABELS, Plot, draw_mesh, lines_on, plain_axes, top};
use super::bars::draw_bars;
use super::figure::SIZE;
use super::label::thousands;
use super::legend::{LEGEND, names_of_bars, names_of_lines, names_of_points};
use super::paint::{GROUND, Numbered, QUIET, Result, numbered, target};
use super::{Chart, Line, Look, Shape};

const CAPTION: u32 = 24;
/// The number of points above which a line has no dots.
const DOTS: usize = 40;

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
        // Each segment is drawn separately, because a thick line drawn as a whole gets a spike
        // across the page at a sharp corner. The gaps of a line whose points lie close together
        // require the line as a whole.
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
