// SPDX-License-Identifier: MIT OR Apache-2.0
//! Charts of bytes against quality: for the design's thresholds and the codecs' quantizers.

use foveate_pictures::chart::{Chart, Line, Look, Shape};

use crate::report::QUANTIZER;
use crate::{ClipReport, Point, Quality};

/// A chart: its file name, the title of its y axis, and the figure of a quality on that axis.
type View = (&'static str, &'static str, fn(&Quality) -> Option<f64>);

const VIEWS: [View; 2] = [
    ("rate-distortion", "PSNR of what the receiver sees [dB]", |quality| quality.psnr),
    ("rate-distortion-ssim", "SSIM of what the receiver sees", |quality| Some(quality.ssim)),
];

/// Draws the charts of a clip; `suffix` is added to their file names.
pub(crate) fn charts(clip: &ClipReport, suffix: &str) -> Vec<Chart> {
    let chart = |&(file, y, part): &View| Chart {
        file: format!("{file}{suffix}"),
        title: format!("Bytes against quality: {}", clip.name),
        x: "bytes per second (logarithmic)".to_owned(),
        y: y.to_owned(),
        caption: caption(clip),
        shape: Shape::LogLines(lines(clip, part)),
    };
    VIEWS.iter().map(chart).collect()
}

fn caption(clip: &ClipReport) -> String {
    let incomplete = if clip.problem.is_some() { " · NOT COMPLETE" } else { "" };
    format!(
        "foveate {} link · design {} · {} frames of {}x{} pixels{incomplete}",
        env!("CARGO_PKG_VERSION"),
        clip.design,
        clip.frames,
        clip.width,
        clip.height
    )
}

/// Returns a line for each codec and each threshold, in the order of the points, and the design as
/// the last line, drawn above all others. Identical frames have no PSNR, and so no point in that
/// chart.
fn lines(clip: &ClipReport, part: fn(&Quality) -> Option<f64>) -> Vec<Line> {
    let place = |bytes: u64, quality: &Quality| Some((coordinate(bytes), part(quality)?));
    let own = clip.senders.iter().find(|sender| sender.sender.starts_with("region"));
    let own = own.and_then(|own| place(own.figures.bytes_per_second, own.quality.as_ref()?));
    let mut lines: Vec<Line> = Vec::new();
    let of_codecs = clip.curves.iter().filter(|point| point.knob == QUANTIZER);
    let of_thresholds = clip.curves.iter().filter(|point| point.knob != QUANTIZER);
    for point in of_codecs.chain(of_thresholds) {
        let name = name(point);
        if lines.last().is_none_or(|line| line.name != name) {
            lines.push(Line { name, ..Line::default() });
        }
        let line = lines.last_mut().expect("one has just been added");
        line.points.extend(place(point.bytes_per_second, &point.quality));
    }
    let points = own.into_iter().collect();
    lines.push(Line { name: "this design".to_owned(), points, look: Look::Target });
    lines
}

fn name(point: &Point) -> String {
    match point.knob {
        QUANTIZER => point.sender.to_owned(),
        key => key.to_owned(),
    }
}

/// Converts a rate to a coordinate above 0, because the axis is logarithmic.
#[allow(clippy::cast_precision_loss, reason = "a coordinate of a chart")]
fn coordinate(rate: u64) -> f64 {
    rate.max(1) as f64
}
