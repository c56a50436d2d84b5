// SPDX-License-Identifier: MIT OR Apache-2.0
//! The charts of a run: the needed share over the network's depth and over the frames, the savings
//! of each frame, and the trials of tuning.

use crate::Layer;
use crate::facts::Attempt;
use crate::frame::Frame;
use crate::summary::{Summary, Tuning};
use foveate_pictures::chart::{Chart, Line, Look, Shape};

/// A chart, and the id of every point of its lines.
pub(crate) struct Drawn {
    pub(crate) chart: Chart,
    pub(crate) ids: Vec<Vec<String>>,
}

/// A line of a chart with an id per point.
struct Series {
    name: String,
    look: Look,
    points: Vec<(String, (f64, f64))>,
}

/// The largest number of clips that a chart tells apart by colour.
const COLOURS: usize = 7;

/// Returns the id of the points of a layer.
pub(crate) fn layer_id(layer: usize) -> String {
    format!("l{layer}")
}

/// Returns the id of the points of a frame, from its place among all frames.
pub(crate) fn frame_id(place: u64) -> String {
    format!("f{place}")
}

/// Returns all trials of tuning in the order of their table, each with the id of its point.
pub(crate) fn tried(tuning: &Tuning) -> Vec<(String, Attempt)> {
    tuning.tried().enumerate().map(|(at, attempt)| (format!("t{at}"), attempt)).collect()
}

/// Draws all charts of the counted frames, for the files and for the page.
pub(crate) fn charts(summary: &Summary, frames: &[&Frame]) -> Vec<Drawn> {
    let caption = format!(
        "foveate {}, {}, mode {}, inputs {}",
        summary.foveate_version,
        summary.network,
        summary.mode,
        summary.inputs.join(" ")
    );
    let mut charts = vec![depth(summary), over_frames(summary, frames), saved(summary, frames)];
    charts.extend(summary.tuning.as_ref().map(tuning));
    for drawn in &mut charts {
        drawn.chart.caption.clone_from(&caption);
    }
    charts
}

/// Draws the share of needed positions over the network's depth; it grows with the halo of the
/// windows.
fn depth(summary: &Summary) -> Drawn {
    let layers = || summary.layers.iter().enumerate().filter(|(_, layer)| layer.macs > 0);
    let line = |name: &str, look, share: fn(&Layer) -> f64| {
        let points = (1u32..)
            .zip(layers())
            .map(|(number, (at, layer))| (layer_id(at), (f64::from(number), 100.0 * share(layer))));
        series(name, look, points)
    };
    chart(
        "depth",
        "What is needed along the network's depth",
        "layer with multiplications, from the input on",
        "share of the layer's positions [%]",
        vec![
            line("needed", Look::Plain, |layer| layer.needed_share),
            // Most layers pass on everything that they compute, so this line often covers the
            // other.
            line("passed on", Look::Open, |layer| layer.changed_share),
        ],
    )
}

fn over_frames(summary: &Summary, frames: &[&Frame]) -> Drawn {
    #[allow(clippy::cast_precision_loss, reason = "a place in a chart")]
    let line = |name: &str, look, share: fn(&Frame) -> f64| {
        let point =
            |frame: &&Frame| (frame_id(frame.place), (frame.place as f64, 100.0 * share(frame)));
        series(name, look, frames.iter().map(point))
    };
    chart(
        "frames",
        "What is needed over the frames",
        if summary.clips.len() > 1 { "frame, clip after clip" } else { "frame" },
        "share [%]",
        vec![
            line("MACs needed", Look::Plain, |frame| frame.macs.needed_share()),
            line("regions changed", Look::Plain, |frame| frame.changed),
            // The active regions are mostly the changed regions, so this line often covers the
            // other.
            line("regions active", Look::Open, |frame| frame.active),
        ],
    )
}

/// Draws the MACs that each frame saves against its share of active regions.
fn saved(summary: &Summary, frames: &[&Frame]) -> Drawn {
    let of = |name: &str, is_shown: &dyn Fn(&Frame) -> bool| {
        let shown = frames.iter().filter(|frame| is_shown(frame) && frame.macs.dense > 0.0);
        let points = shown.map(|frame| {
            let saved = 1.0 - frame.macs.needed_share();
            (frame_id(frame.place), (100.0 * frame.active, 100.0 * saved))
        });
        series(name, Look::Plain, points)
    };
    // There are enough colours to tell this many clips apart.
    let series = if (2..=COLOURS).contains(&summary.clips.len()) {
        let clips = summary.clips.iter().map(|clip| &clip.name);
        clips.map(|clip| of(clip, &|frame| frame.clip == *clip)).collect()
    } else {
        vec![of("a frame", &|_| true)]
    };
    let mut drawn = chart(
        "saved",
        "What is saved against what is active",
        "regions active [%]",
        "MACs saved [%]",
        series,
    );
    if let Shape::Lines(points) = drawn.chart.shape {
        drawn.chart.shape = Shape::Points(points);
    }
    drawn
}

/// Draws the error of each trial against the MACs that it needs, up to the error of outputs that
/// never change.
fn tuning(tuning: &Tuning) -> Drawn {
    let all = tried(tuning);
    let line = |name: &str, look, kinds: &[&str]| {
        let of_kind = all.iter().filter(|(_, (limits, _))| kinds.contains(limits));
        let points = of_kind.map(|(id, (_, tried))| {
            (id.clone(), (100.0 * tried.needed_share, 100.0 * tried.outputs.rms_of_variation))
        });
        series(name, look, points.filter(|(_, (_, error))| error.is_finite()))
    };
    chart(
        "tuning",
        &format!("Error against MACs on the first half, {}", tuning.goal),
        "MACs needed [%]",
        "RMS error of the outputs [% of their standard deviation]",
        vec![
            line("same relative limit", Look::Plain, &["exact", "uniform"]),
            line("never computed again", Look::Plain, &["frozen"]),
            line("chosen", Look::Target, &["chosen"]),
        ],
    )
}

fn series(name: &str, look: Look, points: impl Iterator<Item = (String, (f64, f64))>) -> Series {
    Series { name: name.to_owned(), look, points: points.collect() }
}

fn chart(file: &str, title: &str, x: &str, y: &str, series: Vec<Series>) -> Drawn {
    let (lines, ids) = series
        .into_iter()
        .map(|Series { name, look, points }| {
            let (ids, points) = points.into_iter().unzip();
            (Line { name, points, look }, ids)
        })
        .unzip();
    let chart = Chart {
        file: file.to_owned(),
        title: title.to_owned(),
        x: x.to_owned(),
        y: y.to_owned(),
        caption: String::new(),
        shape: Shape::Lines(lines),
    };
    Drawn { chart, ids }
}
