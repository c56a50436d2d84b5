// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a chart shows ([`Chart`]), and the look of it that does not depend on places: colours,
//! the style that distinguishes one series from another ([`SeriesStyle`]), and the texts of
//! numbers and names.

use crate::palette::{Colour, LIGHT};
use plotters::prelude::*;
use thiserror::Error;

/// The width and height of a chart in pixels.
pub(crate) const SIZE: (u32, u32) = (1000, 560);

/// A chart with its labels and its data.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The name of its files, without extension.
    pub file_stem: String,
    /// The title above the chart.
    pub title: String,
    /// The title of the horizontal axis, with its unit.
    pub x_title: String,
    /// The title of the vertical axis, with its unit.
    pub y_title: String,
    /// The small text at the bottom: program, design and inputs.
    pub caption: String,
    /// The data that are drawn.
    pub shape: ChartData,
}

/// The data of a chart, by the form in which they are drawn.
#[derive(Clone, Debug)]
pub enum ChartData {
    /// Lines over a linear axis.
    Lines(Vec<ChartSeries>),
    /// Points over a linear axis, without lines.
    Points(Vec<ChartSeries>),
    /// Lines over a logarithmic axis, for positive numbers.
    LogLines(Vec<ChartSeries>),
    /// Groups of bars, with one bar per series in every group.
    Bars {
        /// The names of the groups.
        groups: Vec<String>,
        /// The series.
        series: Vec<BarSeries>,
    },
}

/// A line, or a series of points.
#[derive(Clone, Debug, Default)]
pub struct ChartSeries {
    /// The name in the legend.
    pub name: String,
    /// The points; a line connects consecutive ones.
    pub points: Vec<(f64, f64)>,
    /// The look of the line.
    pub look: LineLook,
}

/// The look of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineLook {
    /// A line in the next colour.
    #[default]
    Plain,
    /// A line in the next colour, with gaps and with rings for dots, through which a line below
    /// shows.
    Open,
    /// A mark in front of all lines, with a shape and a colour of its own: the subject of the
    /// chart.
    Target,
}

/// A series with one bar per group.
#[derive(Clone, Debug)]
pub struct BarSeries {
    /// The name in the legend.
    pub name: String,
    /// The colour of the bars.
    pub colour: Colour,
    /// The heights of the bars, by group.
    pub values: Vec<f64>,
    /// The lower and the upper end of a whisker on each bar, or an empty list.
    pub ranges: Vec<(f64, f64)>,
}

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

/// Returns a label with no more digits than necessary.
pub(crate) fn number_label(value: f64) -> String {
    // Values of an axis are sums of steps, so rounding removes their errors.
    ((value * 1e9).round() / 1e9).to_string()
}

/// Returns a label of a logarithmic axis, such as `20 k`.
pub(crate) fn unit_label(value: f64) -> String {
    let units = [(1e9, " G"), (1e6, " M"), (1e3, " k")];
    let unit = units.into_iter().find(|&(size, _)| value >= size).unwrap_or((1.0, ""));
    format!("{}{}", (value / unit.0 * 10.0).round() / 10.0, unit.1)
}

/// Truncates a name to at most this many letters.
pub(crate) fn truncated(name: &str, letters: usize) -> String {
    if name.chars().count() <= letters {
        return name.to_owned();
    }
    name.chars().take(letters - 1).chain(['…']).collect()
}

/// A chart cannot be drawn.
#[derive(Debug, Error)]
#[error("cannot draw the chart `{name}`: {problem}")]
pub struct ChartError {
    /// The name of the chart.
    pub name: String,
    /// The problem.
    pub problem: String,
}
