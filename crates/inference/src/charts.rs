// SPDX-License-Identifier: MIT OR Apache-2.0
//! The charts of a run: the needed share over the network's depth and over the frames, the savings
//! of each frame, and the trials of tuning.

use crate::LayerSummary;
use crate::frame::FrameFigures;
use crate::summary::{InferenceSummary, TuningSummary};
use crate::table_columns::NamedTrial;
use foveate_output::chart::{Chart, ChartData, LineLook};

/// A chart, and the id of every point of its lines.
pub(crate) struct ChartWithIds {
    pub(crate) chart: Chart,
    pub(crate) ids: Vec<Vec<String>>,
}

/// A line of a chart with an id per point.
struct ChartSeries {
    name: String,
    look: LineLook,
    points: Vec<(String, (f64, f64))>,
}

/// The largest number of clips that a chart tells apart by colour.
const MAX_COLOURED_CLIPS: usize = 7;

/// Returns the id of the points of a layer.
pub(crate) fn layer_id(layer: usize) -> String {
    format!("l{layer}")
}

/// Returns the id of the points of a frame, from its place among all frames.
pub(crate) fn frame_id(place: u64) -> String {
    format!("f{place}")
}

/// Returns all trials of tuning in the order of their table, each with the id of its point.
pub(crate) fn trials_with_ids(tuning: &TuningSummary) -> Vec<(String, NamedTrial)> {
    tuning.named_trials().enumerate().map(|(at, attempt)| (format!("t{at}"), attempt)).collect()
}

/// Draws all charts of the counted frames, for the files and for the page.
pub(crate) fn charts(summary: &InferenceSummary, frames: &[&FrameFigures]) -> Vec<ChartWithIds> {
    let caption = format!(
        "foveate {}, {}, mode {}, inputs {}",
        summary.foveate_version,
        summary.network,
        summary.mode,
        summary.inputs.join(" ")
    );
    let mut charts =
        vec![depth_chart(summary), frames_chart(summary, frames), savings_chart(summary, frames)];
    charts.extend(summary.tuning.as_ref().map(tuning_chart));
    for drawn in &mut charts {
        drawn.chart.caption.clone_from(&caption);
    }
    charts
}

/// Draws the share of needed positions over the network's depth; it grows with the halo of the
/// windows.
fn depth_chart(summary: &InferenceSummary) -> ChartWithIds {
    let layers = || summary.layers.iter().enumerate().filter(|(_, layer)| layer.macs > 0);
    let line = |name: &str, look, share: fn(&LayerSummary) -> f64| {
        let points = (1u32..)
            .zip(layers())
            .map(|(number, (at, layer))| (layer_id(at), (f64::from(number), 100.0 * share(layer))));
        series(name, look, points)
    };
    chart(
        "depth",
        "Share needed along the depth of the network",
        "layer with multiplications, from the input on",
        "share of the layer's positions [%]",
        vec![
            line("needed", LineLook::Plain, |layer| layer.needed_share),
            // Most layers pass on everything that they compute, so this line often covers the
            // other.
            line("passed on", LineLook::Open, |layer| layer.changed_share),
        ],
    )
}

fn frames_chart(summary: &InferenceSummary, frames: &[&FrameFigures]) -> ChartWithIds {
    #[allow(clippy::cast_precision_loss, reason = "a place in a chart")]
    let line = |name: &str, look, share: fn(&FrameFigures) -> f64| {
        let point = |frame: &&FrameFigures| {
            (frame_id(frame.index_in_run), (frame.index_in_run as f64, 100.0 * share(frame)))
        };
        series(name, look, frames.iter().map(point))
    };
    chart(
        "frames",
        "Share needed over the frames",
        if summary.clips.len() > 1 { "frame, clip after clip" } else { "frame" },
        "share [%]",
        vec![
            line("MACs needed", LineLook::Plain, |frame| frame.macs.needed_share()),
            line("regions changed", LineLook::Plain, |frame| frame.changed_share),
            // The active regions are mostly the changed regions, so this line often covers the
            // other.
            line("regions active", LineLook::Open, |frame| frame.active_share),
        ],
    )
}

/// Draws the MACs that each frame saves against its share of active regions.
fn savings_chart(summary: &InferenceSummary, frames: &[&FrameFigures]) -> ChartWithIds {
    let of = |name: &str, is_shown: &dyn Fn(&FrameFigures) -> bool| {
        let shown = frames.iter().filter(|frame| is_shown(frame) && frame.macs.whole_frame > 0.0);
        let points = shown.map(|frame| {
            let saved = 1.0 - frame.macs.needed_share();
            (frame_id(frame.index_in_run), (100.0 * frame.active_share, 100.0 * saved))
        });
        series(name, LineLook::Plain, points)
    };
    // There are enough colours to tell this many clips apart.
    let series = if (2..=MAX_COLOURED_CLIPS).contains(&summary.clips.len()) {
        let clips = summary.clips.iter().map(|clip| &clip.name);
        clips.map(|clip| of(clip, &|frame| frame.clip == *clip)).collect()
    } else {
        vec![of("a frame", &|_| true)]
    };
    let mut drawn = chart(
        "saved",
        "MACs saved against active regions",
        "regions active [%]",
        "MACs saved [%]",
        series,
    );
    if let ChartData::Lines(points) = drawn.chart.shape {
        drawn.chart.shape = ChartData::Points(points);
    }
    drawn
}

/// Draws the error of each trial against the MACs that it needs, up to the error of outputs that
/// never change.
fn tuning_chart(tuning: &TuningSummary) -> ChartWithIds {
    let all = trials_with_ids(tuning);
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
            line("same relative limit", LineLook::Plain, &["exact", "uniform"]),
            line("never computed again", LineLook::Plain, &["frozen"]),
            line("chosen", LineLook::Target, &["chosen"]),
        ],
    )
}

fn series(
    name: &str,
    look: LineLook,
    points: impl Iterator<Item = (String, (f64, f64))>,
) -> ChartSeries {
    ChartSeries { name: name.to_owned(), look, points: points.collect() }
}

fn chart(file: &str, title: &str, x: &str, y: &str, series: Vec<ChartSeries>) -> ChartWithIds {
    let (lines, ids) = series
        .into_iter()
        .map(|ChartSeries { name, look, points }| {
            let (ids, points) = points.into_iter().unzip();
            (foveate_output::chart::ChartSeries { name, points, look }, ids)
        })
        .unzip();
    let chart = Chart {
        file_stem: file.to_owned(),
        title: title.to_owned(),
        x_title: x.to_owned(),
        y_title: y.to_owned(),
        caption: String::new(),
        shape: ChartData::Lines(lines),
    };
    ChartWithIds { chart, ids }
}
