// SPDX-License-Identifier: MIT OR Apache-2.0
//! The content of a chart.

use crate::palette::Colour;

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
