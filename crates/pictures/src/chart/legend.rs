// SPDX-License-Identifier: MIT OR Apache-2.0
//! Draws the legend to the right of the plot: the names of series, each with its look.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::label::cut;
use super::paint::{INK, Result, numbered, rgb, target};
use super::{Bars, Line, Look};

/// The width of the legend in pixels.
pub(crate) const LEGEND: u32 = 210;
/// The most letters of a name in the legend.
const LETTERS: usize = 25;

/// Returns the vertical positions of the rows of a legend in pixels.
fn rows() -> impl Iterator<Item = i32> {
    (56..).step_by(22)
}

pub(crate) fn names_of_bars<DB: DrawingBackend>(
    series: &[Bars],
    area: &DrawingArea<DB, Shift>,
) -> Result<DB> {
    for (bars, y) in series.iter().zip(rows()) {
        area.draw(&Rectangle::new([(4, y - 6), (18, y + 6)], rgb(bars.colour).filled()))?;
        name::<DB>(&bars.name, y, area)?;
    }
    Ok(())
}

pub(crate) fn names_of_lines<DB: DrawingBackend>(
    lines: &[Line],
    area: &DrawingArea<DB, Shift>,
) -> Result<DB> {
    for ((number, line), y) in numbered(lines).zip(rows()) {
        name::<DB>(&line.name, y, area)?;
        if line.look == Look::Target {
            target((13, y)).into_iter().try_for_each(|part| area.draw(&part))?;
            continue;
        }
        let pieces: &[(i32, i32)] = if number.is_open { &[(4, 11), (16, 23)] } else { &[(4, 23)] };
        for &(from, to) in pieces {
            let style = number.colour.stroke_width(3);
            area.draw(&PathElement::new(vec![(from, y), (to, y)], style))?;
        }
    }
    Ok(())
}

pub(crate) fn names_of_points<DB: DrawingBackend>(
    series: &[Line],
    area: &DrawingArea<DB, Shift>,
) -> Result<DB> {
    for ((number, points), y) in numbered(series).zip(rows()) {
        area.draw(&Circle::new((13, y), 4, number.colour.filled()))?;
        name::<DB>(&points.name, y, area)?;
    }
    Ok(())
}

fn name<DB: DrawingBackend>(name: &str, y: i32, area: &DrawingArea<DB, Shift>) -> Result<DB> {
    let font = ("sans-serif", 13).into_font().color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
    area.draw(&Text::new(cut(name, LETTERS), (29, y), font))
}
