// SPDX-License-Identifier: MIT OR Apache-2.0
//! Plots for a template: every position is a coordinate in the picture.

use std::collections::BTreeMap;

use askama::Template;

use super::axis::{AxisTick, PlotAxis};
use super::document::group_look;

/// The edges of the frame inside a picture of 560 by 380; the template has the same numbers.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 540.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 316.0;
/// The distance between the frame and the positions of numbers, so that marks do not touch the
/// frame.
const FRAME_PADDING: f64 = 12.0;

/// A plot of marks and lines.
#[derive(Clone, Debug, Default, Template)]
#[template(path = "plot.html")]
pub struct PagePlot {
    /// The id of the plot in the page.
    pub id: String,
    /// The title above the plot.
    pub title: String,
    /// A sentence about the plot.
    pub note: String,
    /// The title of the horizontal axis.
    pub x_title: String,
    /// The title of the vertical axis.
    pub y_title: String,
    /// The ticks of the horizontal axis.
    pub x_ticks: Vec<AxisPosition>,
    /// The ticks of the vertical axis.
    pub y_ticks: Vec<AxisPosition>,
    /// The dashed horizontal lines, for comparison.
    pub horizontal_rules: Vec<AxisPosition>,
    /// The dashed vertical lines.
    pub vertical_rules: Vec<AxisPosition>,
    /// The lines through marks.
    pub lines: Vec<PlotLine>,
    /// The measured points.
    pub marks: Vec<PlotMark>,
    /// True if the colours depend on the chosen axis; otherwise they are those of the lines.
    pub by_axis: bool,
}

impl PagePlot {
    /// Makes an empty plot with these axes and their titles, which say if an axis is logarithmic.
    #[must_use]
    pub fn new(
        id: impl Into<String>,
        title: impl Into<String>,
        axes: &PlotAxes,
        [x_title, y_title]: [&str; 2],
    ) -> Self {
        let titled = |title: &str, axis: PlotAxis| {
            title.to_owned() + if axis.is_logarithmic() { " (log)" } else { "" }
        };
        Self {
            id: id.into(),
            title: title.into(),
            x_title: titled(x_title, axes.x),
            y_title: titled(y_title, axes.y),
            x_ticks: axes.x_ticks(),
            y_ticks: axes.y_ticks(),
            ..Self::default()
        }
    }

    /// Adds a line through points with their marks, which get the position, the colour and the shape
    /// of the line. A point that cannot be shown is left out. Only the marks of a line that is not
    /// joined are drawn.
    pub fn push_line(
        &mut self,
        axes: &PlotAxes,
        label: String,
        is_joined: bool,
        points: impl IntoIterator<Item = (f64, f64, PlotMark)>,
    ) {
        let index = self.lines.len();
        let (class, shape) = group_look(index);
        let mut places = Vec::new();
        for (x, y, mark) in points {
            let Some((x, y)) = axes.coordinates(x, y) else { continue };
            places.push((x, y));
            let (x, y) = (coordinate_text(x), coordinate_text(y));
            self.marks.push(PlotMark { x, y, class: class.clone(), shape, ..mark });
        }
        // Every second line is dashed, so that a line below it shows through its gaps.
        let class = if is_joined && index % 2 == 1 { class + " dashed" } else { class };
        let path = if is_joined { line_path(&places) } else { String::new() };
        self.lines.push(PlotLine { path, class, shape, label });
    }
}

/// A position along an axis.
#[derive(Clone, Debug)]
pub struct AxisPosition {
    /// The coordinate in the picture.
    pub at: String,
    /// The label at this position.
    pub label: String,
}

/// A line of a plot.
#[derive(Clone, Debug)]
pub struct PlotLine {
    /// The path in the syntax of SVG.
    pub path: String,
    /// The class of its colour.
    pub class: String,
    /// The shape of its marks.
    pub shape: &'static str,
    /// The name of the line; empty for a front.
    pub label: String,
}

/// A measured point of a plot.
#[derive(Clone, Debug, Default)]
pub struct PlotMark {
    /// The id in the page; marks with the same id are highlighted together and link to the row of
    /// that id.
    pub id: String,
    /// The horizontal coordinate in the picture.
    pub x: String,
    /// The vertical coordinate in the picture.
    pub y: String,
    /// True if the mark is on a front, and so is large.
    pub front: bool,
    /// True if the mark is only an outline.
    pub hollow: bool,
    /// The label beside the mark, or nothing.
    pub label: String,
    /// The factor of its size, which makes marks of one position rings around each other.
    pub scale: Option<String>,
    /// The class of its colour.
    pub class: String,
    /// The shape, `dot` or `box`.
    pub shape: &'static str,
    /// The group of the mark for every axis.
    pub groups: String,
    /// The figures of the mark.
    pub title: String,
}

/// The two axes of a plot.
#[derive(Clone, Copy, Debug)]
pub struct PlotAxes {
    /// The horizontal axis.
    pub x: PlotAxis,
    /// The vertical axis.
    pub y: PlotAxis,
}

impl PlotAxes {
    /// Returns the coordinates of a point; `None` if a number cannot be shown.
    #[must_use]
    pub fn coordinates(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        Some((x_coordinate(self.x.position(x)?), y_coordinate(self.y.position(y)?)))
    }

    /// Returns the ticks of the horizontal axis.
    #[must_use]
    pub fn x_ticks(&self) -> Vec<AxisPosition> {
        let ticks = self.x.ticks().into_iter();
        spaced_ticks(ticks.map(|tick| (x_coordinate(tick.position), tick)), 46.0)
    }

    /// Returns the ticks of the vertical axis.
    #[must_use]
    pub fn y_ticks(&self) -> Vec<AxisPosition> {
        let ticks = self.y.ticks().into_iter();
        spaced_ticks(ticks.map(|tick| (y_coordinate(tick.position), tick)), 22.0)
    }

    /// Returns a horizontal line at `y`.
    #[must_use]
    pub fn horizontal_line(&self, y: f64, label: String) -> Option<AxisPosition> {
        Some(AxisPosition { at: coordinate_text(y_coordinate(self.y.position(y)?)), label })
    }

    /// Returns a vertical line at `x`.
    #[must_use]
    pub fn vertical_line(&self, x: f64, label: String) -> Option<AxisPosition> {
        Some(AxisPosition { at: coordinate_text(x_coordinate(self.x.position(x)?)), label })
    }
}

fn x_coordinate(place: f64) -> f64 {
    LEFT + FRAME_PADDING + place * (RIGHT - LEFT - 2.0 * FRAME_PADDING)
}

fn y_coordinate(place: f64) -> f64 {
    BOTTOM - FRAME_PADDING - place * (BOTTOM - TOP - 2.0 * FRAME_PADDING)
}

/// Formats a coordinate in the picture.
#[must_use]
pub fn coordinate_text(value: f64) -> String {
    format!("{value:.1}")
}

/// Makes marks at the same position into rings around each other if they look different. The last
/// mark is in front. `size` is the size of marks as a share of the usual one.
pub fn nest_marks(marks: &mut [PlotMark], size: f64) {
    let position = |mark: &PlotMark| (mark.x.clone(), mark.y.clone());
    let look = |mark: &PlotMark| (mark.class.clone(), mark.shape);
    // The looks at a position are in order from the front one to the rear one.
    let mut looks_by_position: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for mark in marks.iter().rev() {
        let looks = looks_by_position.entry(position(mark)).or_default();
        if !looks.contains(&look(mark)) {
            looks.push(look(mark));
        }
    }
    for mark in marks {
        let looks = &looks_by_position[&position(mark)];
        let looks_in_front = looks.iter().position(|other| *other == look(mark));
        let looks_in_front = looks_in_front.expect("every mark was looked at");
        let looks_in_front = u8::try_from(looks_in_front).unwrap_or(u8::MAX);
        let scale = size * (1.0 + f64::from(looks_in_front) / 2.0);
        mark.scale = (looks_in_front > 0 || size < 1.0).then(|| coordinate_text(scale));
    }
}

/// Returns the ticks whose labels do not overlap; the first one is always included.
fn spaced_ticks(
    ticks: impl Iterator<Item = (f64, AxisTick)>,
    min_distance: f64,
) -> Vec<AxisPosition> {
    let mut spaced = Vec::new();
    let mut last = f64::NEG_INFINITY;
    for (at, tick) in ticks {
        if last == f64::NEG_INFINITY || (at - last).abs() >= min_distance {
            last = at;
            spaced.push(AxisPosition { at: coordinate_text(at), label: tick.label });
        }
    }
    spaced
}

/// Returns the path of a line through points.
fn line_path(places: &[(f64, f64)]) -> String {
    let steps = places.iter().enumerate().map(|(index, (x, y))| {
        let letter = if index == 0 { 'M' } else { 'L' };
        format!("{letter}{} {}", coordinate_text(*x), coordinate_text(*y))
    });
    steps.collect::<Vec<_>>().join("")
}

/// Returns the border of the area that a front dominates: from each point along the cost axis to
/// the cost of the next, then to its error. `left` is true if the best costs are on the left, and
/// `low` is true if the best errors are at the bottom.
#[must_use]
pub fn front_path(places: &[(f64, f64)], left: bool, low: bool) -> String {
    let mut places = places.to_vec();
    places.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
    if !left {
        places.reverse();
    }
    let Some(first) = places.first() else { return String::new() };
    let worst = if low { TOP } else { BOTTOM };
    let mut path = format!("M{} {}", coordinate_text(first.0), coordinate_text(worst));
    for (x, y) in &places {
        path += &format!("H{}V{}", coordinate_text(*x), coordinate_text(*y));
    }
    path + &format!("H{}", coordinate_text(if left { RIGHT } else { LEFT }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_is_drawn_as_steps_from_the_best_cost() {
        let places = [(100.0, 200.0), (300.0, 300.0), (200.0, 250.0)];
        assert_eq!(
            front_path(&places, true, true),
            "M100.0 14.0H100.0V200.0H200.0V250.0H300.0V300.0H540.0"
        );
        let places = [(300.0, 200.0), (100.0, 300.0)];
        assert_eq!(front_path(&places, false, true), "M300.0 14.0H300.0V200.0H100.0V300.0H78.0");
        assert_eq!(front_path(&[], true, true), "");
    }

    #[test]
    fn marks_that_would_hide_each_other_are_rings() {
        let mark = |x: &str, class: &str| PlotMark {
            x: x.to_owned(),
            y: "9.0".to_owned(),
            class: class.to_owned(),
            shape: "dot",
            ..PlotMark::default()
        };
        let mut marks = [
            mark("1.0", "k0"),
            mark("2.0", "k0"),
            mark("1.0", "k1"),
            mark("1.0", "k1"),
            mark("1.0", "k2"),
        ];
        nest_marks(&mut marks, 1.0);
        let scales = marks.each_ref().map(|mark| mark.scale.as_deref());
        assert_eq!(scales, [Some("2.0"), None, Some("1.5"), Some("1.5"), None]);
        nest_marks(&mut marks, 0.5);
        let scales = marks.each_ref().map(|mark| mark.scale.as_deref());
        assert_eq!(scales, [Some("1.0"), Some("0.5"), Some("0.8"), Some("0.8"), Some("0.5")]);
    }

    #[test]
    fn ticks_whose_labels_would_touch_are_left_out() {
        let tick = |at: f64| (at, AxisTick { position: 0.0, label: at.to_string() });
        let ticks = spaced_ticks([10.0, 20.0, 70.0].map(tick).into_iter(), 46.0);
        let labels: Vec<&str> = ticks.iter().map(|tick| tick.label.as_str()).collect();
        assert_eq!(labels, ["10", "70"]);
    }
}
