// SPDX-License-Identifier: MIT OR Apache-2.0
//! Draws the legend to the right of the plot: the names of series, each with its look.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::label::truncated;
use super::series_style::{DrawResult, INK, rgb, styled_lines, target_mark};
use super::{BarSeries, ChartSeries, LineLook};

/// The width of the legend in pixels.
pub(crate) const LEGEND_WIDTH: u32 = 210;
/// The most letters of a name in the legend.
const MAX_NAME_LETTERS: usize = 25;

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
    area.draw(&Text::new(truncated(name, MAX_NAME_LETTERS), (29, y), font))
}
