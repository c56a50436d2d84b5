// SPDX-License-Identifier: MIT OR Apache-2.0
//! Draws groups of bars. The names of groups are below them: horizontal if there is room, else
//! vertical.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axes::axis_top;
use super::label::{number_label, truncated};
use super::series_style::{BACKGROUND, DrawResult, GRID, INK, rgb};
use super::{BarSeries, Chart};

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
