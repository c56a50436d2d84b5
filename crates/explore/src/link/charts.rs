// SPDX-License-Identifier: MIT OR Apache-2.0
//! Charts of bytes against quality: for the design's thresholds and the codecs' quantizers.

use foveate_output::chart::{Chart, ChartData, ChartSeries, LineLook};

use crate::link::report::QUANTIZER;
use crate::link::{ClipReport, CurvePoint, Quality};

/// A chart: its file name, the title of its y axis, and the figure of a quality on that axis.
type QualityChart = (&'static str, &'static str, fn(&Quality) -> Option<f64>);

const VIEWS: [QualityChart; 2] = [
    ("rate-distortion", "PSNR of the receiver's screen [dB]", |quality| quality.psnr),
    ("rate-distortion-ssim", "SSIM of the receiver's screen", |quality| Some(quality.ssim)),
];

/// Draws the charts of a clip; `suffix` is added to their file names.
pub(crate) fn charts(clip: &ClipReport, suffix: &str) -> Vec<Chart> {
    let chart = |&(file, y, part): &QualityChart| Chart {
        file_stem: format!("{file}{suffix}"),
        title: format!("Bytes against quality: {}", clip.name),
        x_title: "bytes per second (logarithmic)".to_owned(),
        y_title: y.to_owned(),
        caption: caption(clip),
        shape: ChartData::LogLines(lines(clip, part)),
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
fn lines(clip: &ClipReport, part: fn(&Quality) -> Option<f64>) -> Vec<ChartSeries> {
    let place = |bytes: u64, quality: &Quality| Some((coordinate(bytes), part(quality)?));
    let own = clip.senders.iter().find(|sender| sender.sender.starts_with("region"));
    let own = own.and_then(|own| place(own.figures.bytes_per_second, own.quality.as_ref()?));
    let mut lines: Vec<ChartSeries> = Vec::new();
    let of_codecs = clip.curves.iter().filter(|point| point.setting == QUANTIZER);
    let of_thresholds = clip.curves.iter().filter(|point| point.setting != QUANTIZER);
    for point in of_codecs.chain(of_thresholds) {
        let name = name(point);
        if lines.last().is_none_or(|line| line.name != name) {
            lines.push(ChartSeries { name, ..ChartSeries::default() });
        }
        let line = lines.last_mut().expect("one has just been added");
        line.points.extend(place(point.bytes_per_second, &point.quality));
    }
    let points = own.into_iter().collect();
    lines.push(ChartSeries { name: "this design".to_owned(), points, look: LineLook::Target });
    lines
}

fn name(point: &CurvePoint) -> String {
    match point.setting {
        QUANTIZER => point.sender.to_owned(),
        key => key.to_owned(),
    }
}

/// Converts a rate to a coordinate above 0, because the axis is logarithmic.
#[allow(clippy::cast_precision_loss, reason = "a coordinate of a chart")]
fn coordinate(rate: u64) -> f64 {
    rate.max(1) as f64
}
