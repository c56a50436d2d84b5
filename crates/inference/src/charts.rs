// SPDX-License-Identifier: MIT OR Apache-2.0
//! The charts of a run: what is needed along the network's depth and over the frames, and what tuning could choose between.

use crate::summary::{Summary, Tried, Tuning};
use foveate_chart::{Chart, Line, Shape};

/// Shares of a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    pub(crate) number: u64,
    pub(crate) active: f64,
    pub(crate) changed: f64,
    pub(crate) needed: f64,
}

/// All charts. Frames that are not counted are left out.
pub(crate) fn charts(summary: &Summary, frames: &[Shares]) -> Vec<Chart> {
    let caption = format!(
        "foveate {}, {}, mode {}, inputs {}",
        summary.foveate_version,
        summary.network,
        summary.mode,
        summary.inputs.join(" ")
    );
    let mut charts = vec![depth(summary), over_frames(frames)];
    charts.extend(summary.tuning.as_ref().map(tuning));
    for chart in &mut charts {
        chart.caption.clone_from(&caption);
    }
    charts
}

/// Where the halo of the windows eats what is saved.
fn depth(summary: &Summary) -> Chart {
    let layers = || summary.layers.iter().filter(|layer| layer.macs > 0);
    let line = |name: &str, share: fn(&crate::Layer) -> f64| Line {
        name: name.to_owned(),
        points: (1u32..)
            .zip(layers())
            .map(|(number, layer)| (f64::from(number), 100.0 * share(layer)))
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

fn over_frames(frames: &[Shares]) -> Chart {
    let line = |name: &str, share: fn(&Shares) -> f64| Line {
        name: name.to_owned(),
        #[allow(clippy::cast_precision_loss, reason = "a place in a chart")]
        points: frames.iter().map(|frame| (frame.number as f64, 100.0 * share(frame))).collect(),
    };
    chart(
        "frames",
        "What is needed over the frames",
        "frame",
        "share [%]",
        vec![
            line("MACs needed", |frame| frame.needed),
            line("regions changed", |frame| frame.changed),
            line("regions active", |frame| frame.active),
        ],
    )
}

/// The error of what was tried against what it needs, up to the error of outputs that never change.
fn tuning(tuning: &Tuning) -> Chart {
    let point =
        |tried: &Tried| (100.0 * tried.needed_share, 100.0 * tried.outputs.rms_of_variation);
    let line = |name: &str, tried: &[Tried]| Line {
        name: name.to_owned(),
        points: tried.iter().map(point).filter(|(_, error)| error.is_finite()).collect(),
    };
    let uniform: Vec<Tried> =
        [tuning.exact].into_iter().chain(tuning.uniform.iter().copied()).collect();
    chart(
        "tuning",
        &format!("Error against MACs on the first half of the frames, {}", tuning.goal),
        "MACs needed [%]",
        "RMS error of the outputs [% of their standard deviation]",
        vec![
            line("same relative limit", &uniform),
            line("never computed again", &[tuning.frozen]),
            line("chosen", &[tuning.chosen]),
        ],
    )
}

fn chart(file: &str, title: &str, x: &str, y: &str, lines: Vec<Line>) -> Chart {
    Chart {
        file: file.to_owned(),
        title: title.to_owned(),
        x: x.to_owned(),
        y: y.to_owned(),
        caption: String::new(),
        shape: Shape::Lines(lines),
    }
}
