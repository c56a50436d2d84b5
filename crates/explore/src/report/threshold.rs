// SPDX-License-Identifier: MIT OR Apache-2.0
//! Plots of the active share over a threshold.

use std::collections::BTreeMap;

use foveate_output::{
    number_text::percent,
    page::{PagePlot, PlotAxes, PlotAxis, PlotMark},
};

use super::scatter::stack_marks;
use super::setting::{PointSettings, axes_set};
use crate::DesignRow;

/// The most lines of a plot, which can be told apart.
const MAX_LINES: usize = 8;

/// A line: points that differ only in the threshold, sorted by it.
struct ThresholdLine<'a> {
    points: Vec<(f64, &'a DesignRow, usize)>,
    /// The number of other set axes whose values differ from the ideal's, and the number of other
    /// set axes.
    distance: (usize, usize),
    label: String,
}

/// Returns a plot for every axis that is a threshold and has several values.
pub(crate) fn plots(
    settings: &PointSettings,
    rows: &[&DesignRow],
    titles: &[String],
) -> Vec<PagePlot> {
    let keys = settings.keys.iter().enumerate();
    let thresholds = keys.filter(|(_, key)| {
        let last = key.rsplit('.').next().unwrap_or(key);
        matches!(last, "level" | "min_score" | "min_count")
    });
    thresholds.filter_map(|(axis, _)| plot(settings, rows, titles, axis)).collect()
}

fn plot(
    settings: &PointSettings,
    rows: &[&DesignRow],
    titles: &[String],
    axis: usize,
) -> Option<PagePlot> {
    let mut sweeps = threshold_lines(settings, rows, axis);
    sweeps.sort_by_key(|sweep| {
        (sweep.distance, sweep.points.iter().map(|(_, row, _)| row.number).min())
    });
    let all = sweeps.len();
    sweeps.truncate(MAX_LINES);
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
    let threshold = settings.ideal_value(axis).and_then(|text| text.parse::<f64>().ok());
    let xs = points().map(|(x, _, _)| *x).chain(threshold);
    let ys = points().map(|(_, row, _)| active(row)).chain(ideals.iter().copied());
    let field = PlotAxes { x: PlotAxis::with_free_start(xs), y: PlotAxis::starting_at_zero(ys) };
    let name = &settings.names[axis];
    let mut plot = PagePlot::new(
        format!("threshold-{axis}"),
        format!("Active regions against {name}"),
        &field,
        [&settings.keys[axis], "active area, %"],
    );
    let label = |ideal: f64| format!("ideal camera, {} %", percent(ideal / 100.0));
    plot.horizontal_rules =
        ideals.iter().take(3).filter_map(|y| field.horizontal_line(*y, label(*y))).collect();
    plot.vertical_rules = threshold
        .and_then(|x| field.vertical_line(x, format!("{name} of the ideal")))
        .into_iter()
        .collect();
    if all > MAX_LINES {
        plot.note = format!(
            "{MAX_LINES} of {all} lines are shown: their other settings are nearest to the ideal's."
        );
    }
    for sweep in &sweeps {
        let points = sweep.points.iter().map(|(x, row, of_row)| {
            let (id, title) = (row.number.to_string(), titles[*of_row].clone());
            let mark = PlotMark { id, hollow: !row.qualifies(), title, ..PlotMark::default() };
            (*x, active(row), mark)
        });
        plot.push_line(&field, sweep.label.clone(), true, points);
    }
    stack_marks(&mut plot.marks);
    Some(plot)
}

/// Returns the lines of an axis, without single points.
fn threshold_lines<'a>(
    settings: &PointSettings,
    rows: &[&'a DesignRow],
    axis: usize,
) -> Vec<ThresholdLine<'a>> {
    let mut groups: BTreeMap<Vec<&str>, ThresholdLine<'_>> = BTreeMap::new();
    for (index, row) in rows.iter().enumerate() {
        let Ok(x) = settings.value(row, axis).parse::<f64>() else { continue };
        let others = row.settings.iter().enumerate().filter(|(other, _)| *other != axis);
        let others: Vec<&str> = others.map(|(_, text)| text.as_str()).collect();
        let new = || {
            let set = || axes_set(row).filter(|other| *other != axis);
            let as_ideal = |other: &usize| {
                settings.ideal_value(*other) == Some(settings.value(row, *other).as_str())
            };
            ThresholdLine {
                points: Vec::new(),
                distance: (set().filter(|other| !as_ideal(other)).count(), set().count()),
                label: settings.settings_text(row, Some(axis)),
            }
        };
        groups.entry(others).or_insert_with(new).points.push((x, row, index));
    }
    let mut sweeps: Vec<ThresholdLine<'_>> = groups.into_values().collect();
    for sweep in &mut sweeps {
        sweep.points.sort_by(|one, other| one.0.total_cmp(&other.0));
    }
    let several = |sweep: &ThresholdLine<'_>| {
        sweep.points.first().map(|point| point.0) < sweep.points.last().map(|point| point.0)
    };
    sweeps.retain(several);
    sweeps
}
