// SPDX-License-Identifier: MIT OR Apache-2.0
//! Plots as the template draws them: every place is a number of the picture.

use super::axis::{Axis, Tick};

/// The frame inside a picture of 560 by 380; the template has the same numbers.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 540.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 316.0;
/// Between the frame and the places of numbers, so that marks do not touch it.
const INSIDE: f64 = 12.0;

/// One plot.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plot {
    pub(crate) id: String,
    pub(crate) title: String,
    /// A sentence about it.
    pub(crate) note: String,
    pub(crate) x_title: String,
    pub(crate) y_title: String,
    pub(crate) x_ticks: Vec<At>,
    pub(crate) y_ticks: Vec<At>,
    /// Lines across, dashed: what to compare with.
    pub(crate) rules: Vec<At>,
    /// Lines upwards, dashed.
    pub(crate) posts: Vec<At>,
    pub(crate) lines: Vec<Line>,
    pub(crate) marks: Vec<Mark>,
    /// Whether colours are those of the chosen axis; otherwise those of the lines.
    pub(crate) by_axis: bool,
}

/// A place along an axis.
#[derive(Clone, Debug)]
pub(crate) struct At {
    pub(crate) at: String,
    pub(crate) label: String,
}

/// A line.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) path: String,
    pub(crate) class: String,
    /// Shape of its marks.
    pub(crate) shape: &'static str,
    /// What it is; empty for a front.
    pub(crate) label: String,
}

/// A point of the exploration.
#[derive(Clone, Debug)]
pub(crate) struct Mark {
    pub(crate) number: usize,
    pub(crate) x: String,
    pub(crate) y: String,
    pub(crate) front: bool,
    /// How much larger it is, so that marks of one place are rings around each other.
    pub(crate) scale: Option<String>,
    /// Class of its colour.
    pub(crate) class: String,
    /// `dot` or `box`.
    pub(crate) shape: &'static str,
    /// Its group for every axis.
    pub(crate) groups: String,
    pub(crate) title: String,
}

/// Where numbers are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    pub(crate) x: Axis,
    pub(crate) y: Axis,
}

impl Field {
    /// Where a point is; none for what is no number.
    pub(crate) fn place(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        Some((across(self.x.place(x)?), up(self.y.place(y)?)))
    }

    pub(crate) fn x_ticks(&self) -> Vec<At> {
        let ticks = self.x.ticks().into_iter();
        spaced(ticks.map(|tick| (across(tick.at), tick)), 46.0)
    }

    pub(crate) fn y_ticks(&self) -> Vec<At> {
        let ticks = self.y.ticks().into_iter();
        spaced(ticks.map(|tick| (up(tick.at), tick)), 22.0)
    }

    /// A line across at `y`.
    pub(crate) fn rule(&self, y: f64, label: String) -> Option<At> {
        Some(At { at: text(up(self.y.place(y)?)), label })
    }

    /// A line upwards at `x`.
    pub(crate) fn post(&self, x: f64, label: String) -> Option<At> {
        Some(At { at: text(across(self.x.place(x)?)), label })
    }
}

fn across(place: f64) -> f64 {
    LEFT + INSIDE + place * (RIGHT - LEFT - 2.0 * INSIDE)
}

fn up(place: f64) -> f64 {
    BOTTOM - INSIDE - place * (BOTTOM - TOP - 2.0 * INSIDE)
}

/// A number of the picture.
pub(crate) fn text(value: f64) -> String {
    format!("{value:.1}")
}

/// Ticks of which no two are too near for their labels; the lowest stays.
fn spaced(ticks: impl Iterator<Item = (f64, Tick)>, least: f64) -> Vec<At> {
    let mut found = Vec::new();
    let mut last = f64::NEG_INFINITY;
    for (at, tick) in ticks {
        if last == f64::NEG_INFINITY || (at - last).abs() >= least {
            last = at;
            found.push(At { at: text(at), label: tick.label });
        }
    }
    found
}

/// A line through places.
pub(crate) fn through(places: &[(f64, f64)]) -> String {
    let steps = places.iter().enumerate().map(|(index, (x, y))| {
        let letter = if index == 0 { 'M' } else { 'L' };
        format!("{letter}{} {}", text(*x), text(*y))
    });
    steps.collect::<Vec<_>>().join("")
}

/// The border of what a front beats, through its places: along the cost until the next one is in
/// reach, then to its error. `left` says that costs are best on the left, `low` that errors are best
/// below.
pub(crate) fn staircase(places: &[(f64, f64)], left: bool, low: bool) -> String {
    let mut places = places.to_vec();
    places.sort_by(|one, other| one.0.total_cmp(&other.0).then(other.1.total_cmp(&one.1)));
    if !left {
        places.reverse();
    }
    let Some(first) = places.first() else { return String::new() };
    let worst = if low { TOP } else { BOTTOM };
    let mut path = format!("M{} {}", text(first.0), text(worst));
    for (x, y) in &places {
        path += &format!("H{}V{}", text(*x), text(*y));
    }
    path + &format!("H{}", text(if left { RIGHT } else { LEFT }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_is_steps_from_the_best_cost() {
        let places = [(100.0, 200.0), (300.0, 300.0), (200.0, 250.0)];
        assert_eq!(
            staircase(&places, true, true),
            "M100.0 14.0H100.0V200.0H200.0V250.0H300.0V300.0H540.0"
        );
        let places = [(300.0, 200.0), (100.0, 300.0)];
        assert_eq!(staircase(&places, false, true), "M300.0 14.0H300.0V200.0H100.0V300.0H78.0");
        assert_eq!(staircase(&[], true, true), "");
    }

    #[test]
    fn labels_do_not_touch() {
        let tick = |at: f64| (at, Tick { at: 0.0, label: at.to_string() });
        let ticks = spaced([10.0, 20.0, 70.0].map(tick).into_iter(), 46.0);
        let labels: Vec<&str> = ticks.iter().map(|tick| tick.label.as_str()).collect();
        assert_eq!(labels, ["10", "70"]);
    }
}
