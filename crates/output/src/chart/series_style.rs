// SPDX-License-Identifier: MIT OR Apache-2.0
//! The colours of a chart, and the style that distinguishes one series from another.

use plotters::prelude::*;

use super::{ChartSeries, LineLook};
use crate::palette::{Colour, LIGHT};

pub(crate) const BACKGROUND: RGBColor = rgb(LIGHT.background);
pub(crate) const INK: RGBColor = rgb(LIGHT.ink);
pub(crate) const SECONDARY: RGBColor = rgb(LIGHT.secondary);
pub(crate) const GRID: RGBColor = rgb(LIGHT.grid);

pub(crate) type DrawResult<DB> =
    Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// The style that distinguishes a line from the others.
#[derive(Clone, Copy)]
pub(crate) struct SeriesStyle {
    pub(crate) colour: RGBColor,
    /// True if a line below shows through this one.
    pub(crate) is_open: bool,
}

/// Returns the lines with their colours; a target needs none. When all colours are used, they are
/// used again from the first on, with gaps in the lines.
pub(crate) fn styled_lines(
    lines: &[ChartSeries],
) -> impl Iterator<Item = (SeriesStyle, &ChartSeries)> {
    let colours = LIGHT.series.len();
    let mut next = 0;
    lines.iter().map(move |line| {
        if line.look == LineLook::Target {
            return (SeriesStyle { colour: INK, is_open: false }, line);
        }
        let number = next;
        next += 1;
        let colour = rgb(LIGHT.series[number % colours]);
        (SeriesStyle { colour, is_open: line.look == LineLook::Open || number >= colours }, line)
    })
}

/// Returns a disc with a ring and a dot, which is drawn in front of all lines.
pub(crate) fn target_mark<C: Clone>(at: C) -> [Circle<C, u32>; 3] {
    [
        Circle::new(at.clone(), 9, BACKGROUND.filled()),
        Circle::new(at.clone(), 7, INK.stroke_width(2)),
        Circle::new(at, 3, INK.filled()),
    ]
}

pub(crate) const fn rgb([red, green, blue]: Colour) -> RGBColor {
    RGBColor(red, green, blue)
}
