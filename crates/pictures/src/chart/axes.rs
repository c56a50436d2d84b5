// SPDX-License-Identifier: MIT OR Apache-2.0
//! The axes of a chart: their ranges, labels and grid.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::label::plain;
use super::paint::{GRID, GROUND, Result};
use super::{Chart, Line};

/// The most labels of a horizontal axis.
pub(crate) const LABELS: u8 = 11;

/// A plot with its axes, which series are drawn into.
pub(crate) type Plot<'a, DB, X> = ChartContext<'a, DB, Cartesian2d<X, RangedCoordf64>>;

/// Returns the upper end of an axis: a little more than the largest value, so that no line touches
/// the frame.
pub(crate) fn top(values: impl Iterator<Item = f64>) -> f64 {
    let largest = values.fold(0.0, f64::max);
    if largest > 0.0 { 1.05 * largest } else { 1.0 }
}

/// Returns the builder of a chart of lines, before its axes are set.
pub(crate) fn lines_on<'a, DB: DrawingBackend>(
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
pub(crate) fn plain_axes<'a, DB: DrawingBackend>(
    chart: &Chart,
    lines: &[Line],
    area: &'a DrawingArea<DB, Shift>,
) -> std::result::Result<Plot<'a, DB, RangedCoordf64>, DrawingAreaErrorKind<DB::ErrorType>> {
    let points = || lines.iter().flat_map(|line| line.points.iter().copied());
    let last = points().map(|point| point.0).fold(0.0, f64::max);
    let last = if last > 0.0 { last } else { 1.0 };
    let height = top(points().map(|point| point.1));
    let mut context = lines_on(chart, area).build_cartesian_2d(0.0..last, 0.0..height)?;
    // If every value is a whole number, there are no more labels than whole numbers.
    let whole = points().all(|(x, _)| x.fract() == 0.0).then(|| whole_labels(last));
    draw_mesh(chart, &mut context, whole.unwrap_or(LABELS), &|&x| plain(x))?;
    Ok(context)
}

/// Returns the number of labels from 0 to `last`, at most one for each whole number.
fn whole_labels(last: f64) -> u8 {
    let more = (1..LABELS).take_while(|&label| f64::from(label) <= last);
    more.last().unwrap_or(0) + 1
}

/// Draws the grid with labels on it.
pub(crate) fn draw_mesh<DB: DrawingBackend, X: Ranged<ValueType = f64> + ValueFormatter<f64>>(
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
