// SPDX-License-Identifier: MIT OR Apache-2.0
//! The charts as plots of the page: the same lines, with a mark for every point that shows its
//! figures.

use crate::charts::ChartWithIds;
use foveate_output::{
    chart::ChartData,
    page::{
        PagePlot, PlotAxes, PlotAxis, PlotLine, PlotMark, coordinate_text, group_look, line_path,
        nest_marks,
    },
};
use std::collections::BTreeMap;

/// The number of points of a line above which its marks are smaller.
const MAX_LARGE_MARKS: usize = 80;

/// Converts a chart to a plot. `titles` has the figures of every id; `note` says which frames are
/// left out.
pub(super) fn plot(drawn: &ChartWithIds, titles: &BTreeMap<&str, &str>, note: &str) -> PagePlot {
    let (lines, is_joined) = match &drawn.chart.shape {
        ChartData::Lines(lines) => (lines, true),
        ChartData::Points(points) => (points, false),
        _ => return PagePlot::default(),
    };
    let xs = || lines.iter().flat_map(|line| line.points.iter().map(|&(x, _)| x));
    let ys = || lines.iter().flat_map(|line| line.points.iter().map(|&(_, y)| y));
    let is_frames = ["frames", "saved"].contains(&&drawn.chart.file_stem[..]);
    let is_tuning = drawn.chart.file_stem == "tuning";
    let field = if is_tuning {
        PlotAxes {
            x: PlotAxis::always_linear(xs().chain([0.0])),
            y: PlotAxis::starting_at_zero(ys()),
        }
    } else if !is_joined {
        PlotAxes {
            x: PlotAxis::always_linear(xs().chain([0.0])),
            y: PlotAxis::always_linear(ys().chain([0.0])),
        }
    } else {
        PlotAxes { x: PlotAxis::always_linear(xs()), y: PlotAxis::always_linear(ys().chain([0.0])) }
    };
    // The axis of the tuning plot has no room for the words of the chart.
    let y_title = if is_tuning { "error [% of variation]" } else { &drawn.chart.y_title };
    let logarithmic = if field.y.is_logarithmic() { " (log)" } else { "" };
    let mut plot = PagePlot {
        id: drawn.chart.file_stem.clone(),
        title: drawn.chart.title.clone(),
        note: if is_frames { note.to_owned() } else { String::new() },
        x_title: drawn.chart.x_title.clone(),
        y_title: format!("{y_title}{logarithmic}"),
        x_ticks: field.x_ticks(),
        y_ticks: field.y_ticks(),
        ..PagePlot::default()
    };
    if !is_tuning && is_joined {
        // Numbers of layers and frames are whole.
        plot.x_ticks.retain(|tick| !tick.label.contains('.'));
    }
    for (index, (line, ids)) in lines.iter().zip(&drawn.ids).enumerate() {
        let (class, shape) = group_look(index);
        let mut places = Vec::new();
        for (&(x, y), id) in line.points.iter().zip(ids) {
            let Some(place) = field.coordinates(x, y) else { continue };
            places.push(place);
            let figures = titles.get(id.as_str()).copied().unwrap_or_default();
            plot.marks.push(PlotMark {
                id: id.clone(),
                x: coordinate_text(place.0),
                y: coordinate_text(place.1),
                class: class.clone(),
                shape,
                title: figures.to_owned(),
                ..PlotMark::default()
            });
        }
        // Every second line is dashed, so that a line below it shows through its gaps.
        let class = if is_joined && index % 2 == 1 { class + " dashed" } else { class };
        let path = if is_joined { line_path(&places) } else { String::new() };
        plot.lines.push(PlotLine { path, class, shape, label: line.name.clone() });
    }
    let is_many = lines.iter().any(|line| line.points.len() > MAX_LARGE_MARKS);
    nest_marks(&mut plot.marks, if is_many { 0.5 } else { 1.0 });
    plot
}
