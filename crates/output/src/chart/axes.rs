// SPDX-License-Identifier: MIT OR Apache-2.0
//! The axes of a chart: their ranges, labels and grid.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::label::number_label;
use super::series_style::{BACKGROUND, DrawResult, GRID};
use super::{Chart, ChartSeries};

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
