// SPDX-License-Identifier: MIT OR Apache-2.0
//! The charts of a run: what is needed along the network's depth and over the frames, what frames save, and what tuning could choose between.

use crate::Layer;
use crate::macs::Macs;
use crate::summary::{Summary, Tried, Tuning};
use foveate_pictures::chart::{Chart, Line, Look, Shape};

/// A counted frame.
#[derive(Clone, Debug)]
pub(crate) struct Counted {
    /// Its number among the frames of all clips, one after the other.
    pub(crate) place: u64,
    pub(crate) clip: String,
    /// Its number in its clip.
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
    name: String,
    look: Look,
    points: Vec<(String, (f64, f64))>,
}

/// Clips that a chart shows apart.
const COLOURS: usize = 7;

/// What a layer is called among the points.
pub(crate) fn layer_id(layer: usize) -> String {
    format!("l{layer}")
}

/// What a frame is called among the points, by its place.
pub(crate) fn frame_id(place: u64) -> String {
    format!("f{place}")
}

/// Everything that tuning tried in the order of its table, with its name among the points.
pub(crate) fn tried(tuning: &Tuning) -> Vec<(String, &'static str, Tried)> {
    let all = tuning.tried().enumerate();
    all.map(|(at, (limits, tried))| (format!("t{at}"), limits, tried)).collect()
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
    let mut charts = vec![depth(summary), over_frames(summary, frames), saved(summary, frames)];
    charts.extend(summary.tuning.as_ref().map(tuning));
    for drawn in &mut charts {
        drawn.chart.caption.clone_from(&caption);
    }
    charts
}

/// Where the halo of the windows eats what is saved.
fn depth(summary: &Summary) -> Drawn {
    let layers = || summary.layers.iter().enumerate().filter(|(_, layer)| layer.macs > 0);
    let line = |name: &str, look, share: fn(&Layer) -> f64| Series {
        name: name.to_owned(),
        look,
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
            line("needed", Look::Plain, |layer| layer.needed_share),
            // Most layers pass on all that they compute.
            line("passed on", Look::Open, |layer| layer.changed_share),
        ],
    )
}

fn over_frames(summary: &Summary, frames: &[Counted]) -> Drawn {
    let line = |name: &str, look, share: fn(&Counted) -> f64| Series {
        name: name.to_owned(),
        look,
        #[allow(clippy::cast_precision_loss, reason = "a place in a chart")]
        points: frames
            .iter()
            .map(|frame| (frame_id(frame.place), (frame.place as f64, 100.0 * share(frame))))
            .collect(),
    };
    chart(
        "frames",
        "What is needed over the frames",
        if summary.clips.len() > 1 { "frame, clip after clip" } else { "frame" },
        "share [%]",
        vec![
            line("MACs needed", Look::Plain, |frame| frame.macs.share(frame.macs.needed)),
            line("regions changed", Look::Plain, |frame| frame.changed),
            // Mostly the same regions.
            line("regions active", Look::Open, |frame| frame.active),
        ],
    )
}

/// What each frame saves against what the camera sends of it.
fn saved(summary: &Summary, frames: &[Counted]) -> Drawn {
    let of = |name: &str, is_shown: &dyn Fn(&&Counted) -> bool| Series {
        name: name.to_owned(),
        look: Look::Plain,
        points: frames
            .iter()
            .filter(is_shown)
            .filter(|frame| frame.macs.dense > 0.0)
            .map(|frame| {
                let saved = 1.0 - frame.macs.share(frame.macs.needed);
                (frame_id(frame.place), (100.0 * frame.active, 100.0 * saved))
            })
            .collect(),
    };
    // Colours tell so many clips apart.
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

/// The error of what was tried against what it needs, up to the error of outputs that never change.
fn tuning(tuning: &Tuning) -> Drawn {
    let all = tried(tuning);
    let line = |name: &str, look, kinds: &[&str]| Series {
        name: name.to_owned(),
        look,
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
