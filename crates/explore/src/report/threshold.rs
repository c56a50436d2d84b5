// SPDX-License-Identifier: MIT OR Apache-2.0
//! Plots of the active share over a threshold.

use std::collections::BTreeMap;

use foveate_pictures::page::number::percent;
use foveate_pictures::page::{Axis, Field, Line, Mark, Plot, look, text, through};

use super::scatter::stack;
use super::setting::{Settings, set};
use crate::DesignRow;

/// The most lines of a plot, which can be told apart.
const LINES: usize = 8;

/// A line: points that differ only in the threshold, sorted by it.
struct Sweep<'a> {
    points: Vec<(f64, &'a DesignRow, usize)>,
    /// The number of other set axes whose values differ from the ideal's, and the number of other
    /// set axes.
    distance: (usize, usize),
    label: String,
}

/// Returns a plot for every axis that is a threshold and has several values.
pub(crate) fn plots(settings: &Settings, rows: &[&DesignRow], titles: &[String]) -> Vec<Plot> {
    let keys = settings.keys.iter().enumerate();
    let thresholds = keys.filter(|(_, key)| {
        let last = key.rsplit('.').next().unwrap_or(key);
        matches!(last, "level" | "min_score" | "min_count")
    });
    thresholds.filter_map(|(axis, _)| plot(settings, rows, titles, axis)).collect()
}

fn plot(settings: &Settings, rows: &[&DesignRow], titles: &[String], axis: usize) -> Option<Plot> {
    let mut sweeps = sweeps(settings, rows, axis);
    sweeps.sort_by_key(|sweep| {
        (sweep.distance, sweep.points.iter().map(|(_, row, _)| row.number).min())
    });
    let all = sweeps.len();
    sweeps.truncate(LINES);
    let points = || sweeps.iter().flat_map(|sweep| &sweep.points);
    let mut ideals: Vec<f64> = Vec::new();
    for (_, row, _) in points() {
        let ideal = 100.0 * row.figures.ideal_active;
        if !ideals.iter().any(|known| (known - ideal).abs() < 1e-9) {
            ideals.push(ideal);
        }
    }
    points().next()?;
    let active = |row: &DesignRow| 100.0 * row.figures.active;
    let threshold = settings.ideal(axis).and_then(|text| text.parse::<f64>().ok());
    let xs = points().map(|(x, _, _)| *x).chain(threshold);
    let ys = points().map(|(_, row, _)| active(row)).chain(ideals.iter().copied());
    let field = Field { x: Axis::free(xs), y: Axis::from_zero(ys) };
    let name = &settings.names[axis];
    let mut plot = Plot {
        id: format!("threshold-{axis}"),
        title: format!("Active regions against {name}"),
        x_title: title(&settings.keys[axis], field.x),
        y_title: title("active area, %", field.y),
        x_ticks: field.x_ticks(),
        y_ticks: field.y_ticks(),
        ..Plot::default()
    };
    let label = |ideal: f64| format!("ideal camera, {} %", percent(ideal / 100.0));
    plot.rules = ideals.iter().take(3).filter_map(|y| field.rule(*y, label(*y))).collect();
    plot.posts =
        threshold.and_then(|x| field.post(x, format!("{name} of the ideal"))).into_iter().collect();
    if all > LINES {
        plot.note = format!(
            "{LINES} of {all} lines are shown: their other settings are nearest to the ideal's."
        );
    }
    for (index, sweep) in sweeps.iter().enumerate() {
        let (class, shape) = look(index);
        let mut places = Vec::new();
        for (x, row, of_row) in &sweep.points {
            let Some(place) = field.place(*x, active(row)) else { continue };
            places.push(place);
            plot.marks.push(Mark {
                id: row.number.to_string(),
                x: text(place.0),
                y: text(place.1),
                front: false,
                scale: None,
                class: class.clone(),
                shape,
                groups: String::new(),
                title: titles[*of_row].clone(),
            });
        }
        let class = if index % 2 == 1 { class + " dashed" } else { class };
        plot.lines.push(Line { path: through(&places), class, shape, label: sweep.label.clone() });
    }
    stack(&mut plot.marks);
    Some(plot)
}

fn title(text: &str, axis: Axis) -> String {
    format!("{text}{}", if axis.logarithmic() { " (log)" } else { "" })
}

/// Returns the lines of an axis, without single points.
fn sweeps<'a>(settings: &Settings, rows: &[&'a DesignRow], axis: usize) -> Vec<Sweep<'a>> {
    let mut groups: BTreeMap<Vec<&str>, Sweep<'_>> = BTreeMap::new();
    for (index, row) in rows.iter().enumerate() {
        let Ok(x) = settings.value(row, axis).parse::<f64>() else { continue };
        let others = row.settings.iter().enumerate().filter(|(other, _)| *other != axis);
        let others: Vec<&str> = others.map(|(_, text)| text.as_str()).collect();
        let new = || {
            let set = || set(row).filter(|other| *other != axis);
            let as_ideal = |other: &usize| {
                settings.ideal(*other) == Some(settings.value(row, *other).as_str())
            };
            Sweep {
                points: Vec::new(),
                distance: (set().filter(|other| !as_ideal(other)).count(), set().count()),
                label: settings.described(row, Some(axis)),
            }
        };
        groups.entry(others).or_insert_with(new).points.push((x, row, index));
    }
    let mut sweeps: Vec<Sweep<'_>> = groups.into_values().collect();
    for sweep in &mut sweeps {
        sweep.points.sort_by(|one, other| one.0.total_cmp(&other.0));
    }
    let several = |sweep: &Sweep<'_>| {
        sweep.points.first().map(|point| point.0) < sweep.points.last().map(|point| point.0)
    };
    sweeps.retain(several);
    sweeps
}
