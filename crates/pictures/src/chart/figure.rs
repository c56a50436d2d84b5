// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a chart shows.

use crate::palette::Colour;

/// Width and height of a chart in pixels.
pub(crate) const SIZE: (u32, u32) = (1000, 560);

/// A chart.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The name of its files, without extension.
    pub file: String,
    /// Above the chart.
    pub title: String,
    /// With its unit, as for the other axis.
    pub x: String,
    /// With its unit.
    pub y: String,
    /// Small, at the bottom: program, design and inputs.
    pub caption: String,
    /// What is drawn.
    pub shape: Shape,
}

/// What is drawn.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Lines over numbers.
    Lines(Vec<Line>),
    /// Points over numbers, without lines.
    Points(Vec<Line>),
    /// Lines over numbers above 0, on a logarithmic axis.
    LogLines(Vec<Line>),
    /// Groups of bars, one group per name, one bar per series.
    Bars {
        /// Names of the groups.
        groups: Vec<String>,
        /// A bar in every group each.
        series: Vec<Bars>,
    },
}

/// A line, or points of one kind.
#[derive(Clone, Debug, Default)]
pub struct Line {
    /// Its name in the legend.
    pub name: String,
    /// Its points; a line goes from one to the next.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub look: Look,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// In the next colour.
    #[default]
    Plain,
    /// In the next colour, with gaps and with rings for dots, through which a line below shows.
    Open,
    /// In front of all, in a form and a colour of its own: what the chart is about.
    Target,
}

/// One bar per group.
#[derive(Clone, Debug)]
pub struct Bars {
    /// Their name in the legend.
    pub name: String,
    /// Their colour.
    pub colour: Colour,
    /// Their heights.
    pub values: Vec<f64>,
    /// From and to, a whisker on every bar; or none.
    pub ranges: Vec<(f64, f64)>,
}
