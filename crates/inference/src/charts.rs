// SPDX-License-Identifier: MIT OR Apache-2.0
//! The charts of a run: what is needed along the network's depth and over the frames, and what tuning could choose between.

use crate::Layer;
use crate::summary::{Macs, Summary, Tried, Tuning};
use foveate_chart::{Chart, Line, Shape};

/// A counted frame.
#[derive(Clone, Debug)]
pub(crate) struct Counted {
    pub(crate) number: u64,
    pub(crate) name: String,
    /// Share of regions that were active.
    pub(crate) active: f64,
    pub(crate) changed: f64,
    pub(crate) macs: Macs,
    pub(crate) seconds: f64,
    pub(crate) relative_rms: Option<f64>,
}

/// A chart, and what each point of each line belongs to.
pub(crate) struct Drawn {
    pub(crate) chart: Chart,
    pub(crate) ids: Vec<Vec<String>>,
}

/// A line whose points belong to something.
struct Series {
    name: &'static str,
    points: Vec<(String, (f64, f64))>,
}

/// What a layer is called among the points.
pub(crate) fn layer_id(layer: usize) -> String {
    format!("l{layer}")
}

/// What a frame is called among the points.
pub(crate) fn frame_id(frame: u64) -> String {
    format!("f{frame}")
}

/// Everything that tuning tried in the order of its table, with its name among the points.
pub(crate) fn tried(tuning: &Tuning) -> Vec<(String, &'static str, Tried)> {
    let uniform = tuning.uniform.iter().map(|tried| ("uniform", *tried));
    let others = [("frozen", tuning.frozen), ("chosen", tuning.chosen)];
    let all = [("exact", tuning.exact)].into_iter().chain(uniform).chain(others);
    all.enumerate().map(|(at, (limits, tried))| (format!("t{at}"), limits, tried)).collect()
}

/// All charts. Frames that are not counted are left out.
pub(crate) fn charts(summary: &Summary, frames: &[Counted]) -> Vec<Drawn> {
    let caption = format!(
        "foveate {}, {}, mode {}, inputs {}",
        summary.foveate_version,
        summary.network,
        summary.mode,
        summary.inputs.join(" ")
    );
    let mut charts = vec![depth(summary), over_frames(frames)];
    charts.extend(summary.tuning.as_ref().map(tuning));
    for drawn in &mut charts {
        drawn.chart.caption.clone_from(&caption);
    }
    charts
}

/// Where the halo of the windows eats what is saved.
fn depth(summary: &Summary) -> Drawn {
    let layers = || summary.layers.iter().enumerate().filter(|(_, layer)| layer.macs > 0);
    let line = |name, share: fn(&Layer) -> f64| Series {
        name,
        points: (1u32..)
            .zip(layers())
            .map(|(number, (at, layer))| (layer_id(at), (f64::from(number), 100.0 * share(layer))))
            .collect(),
    };
    chart(
        "depth",
        "What is needed along the network's depth",
        "layer with multiplications, from the input on",
        "share of the layer's positions [%]",
        vec![
            line("needed", |layer| layer.needed_share),
            line("passed on", |layer| layer.changed_share),
        ],
    )
}

fn over_frames(frames: &[Counted]) -> Drawn {
    let line = |name, share: fn(&Counted) -> f64| Series {
        name,
        #[allow(clippy::cast_precision_loss, reason = "a place in a chart")]
        points: frames
            .iter()
            .map(|frame| (frame_id(frame.number), (frame.number as f64, 100.0 * share(frame))))
            .collect(),
    };
    chart(
        "frames",
        "What is needed over the frames",
        "frame",
        "share [%]",
        vec![
            line("MACs needed", |frame| frame.macs.share(frame.macs.needed)),
            line("regions changed", |frame| frame.changed),
            line("regions active", |frame| frame.active),
        ],
    )
}

/// The error of what was tried against what it needs, up to the error of outputs that never change.
fn tuning(tuning: &Tuning) -> Drawn {
    let all = tried(tuning);
    let line = |name, kinds: &[&str]| Series {
        name,
        points: all
            .iter()
            .filter(|(_, limits, _)| kinds.contains(limits))
            .map(|(id, _, tried)| {
                let error = 100.0 * tried.outputs.rms_of_variation;
                (id.clone(), (100.0 * tried.needed_share, error))
            })
            .filter(|(_, (_, error))| error.is_finite())
            .collect(),
    };
    chart(
        "tuning",
        &format!("Error against MACs on the first half of the frames, {}", tuning.goal),
        "MACs needed [%]",
        "RMS error of the outputs [% of their standard deviation]",
        vec![
            line("same relative limit", &["exact", "uniform"]),
            line("never computed again", &["frozen"]),
            line("chosen", &["chosen"]),
        ],
    )
}

fn chart(file: &str, title: &str, x: &str, y: &str, series: Vec<Series>) -> Drawn {
    let (lines, ids) = series
        .into_iter()
        .map(|Series { name, points }| {
            let (ids, points) = points.into_iter().unzip();
            (Line { name: name.to_owned(), points }, ids)
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
