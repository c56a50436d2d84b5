// SPDX-License-Identifier: MIT OR Apache-2.0
//! The figures of a run in the form in which the page shows them: as numbers with units, in the
//! heading ([`heading_facts`]), as plots with a mark for every point that tells its figures
//! ([`plot`]), and as pictures of the receiver's screen with the detections in them and in
//! whole frames ([`frame_pictures`]).

use crate::charts::ChartWithIds;
use crate::whole_frames::{KeptScreen, KeptScreens};
use crate::{Detection, InferenceSummary};
use askama::Template;
use foveate_output::chart::{Chart, ChartData};
use foveate_output::number_text::{MISSING, grouped, percent, real_number};
use foveate_output::page::{
    HeadingFigure, PageError, PagePlot, PlotAxes, PlotAxis, PlotMark, nest_marks,
};
use std::collections::BTreeMap;

/// Formats a share as a percentage.
pub(super) fn share_text(value: f64) -> String {
    format!("{} %", percent(value))
}

/// Formats an error as zero or with three digits.
pub(super) fn error_text(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ if value.is_finite() => format!("{value:.2e}"),
        _ => MISSING.to_owned(),
    }
}

/// Formats a PSNR with its unit; equal outputs have an infinite PSNR.
pub(super) fn decibels_text(psnr: Option<f64>) -> String {
    psnr.map_or("infinite".to_owned(), |psnr| {
        if psnr.is_finite() { format!("{psnr:.1} dB") } else { MISSING.to_owned() }
    })
}

/// Formats a number of bytes with a unit.
#[allow(clippy::cast_precision_loss, reason = "shown with three digits")]
pub(super) fn bytes_text(count: u64) -> String {
    let size = count as f64;
    match count {
        0..1_000 => format!("{count} bytes"),
        1_000..1_000_000 => format!("{:.1} kB", size / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", size / 1e6),
        _ => format!("{:.2} GB", size / 1e9),
    }
}

/// Formats a mean number of bytes with a unit.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a mean of bytes is one"
)]
pub(super) fn mean_bytes_text(count: f64) -> String {
    bytes_text(count.round() as u64)
}

/// Formats a large count with a unit.
pub(super) fn large_count_text(count: f64) -> String {
    match count {
        _ if !count.is_finite() => MISSING.to_owned(),
        0.0..1e4 => real_number(count, 0),
        1e4..1e9 => format!("{} M", real_number(count / 1e6, if count < 1e5 { 3 } else { 1 })),
        _ => format!("{} G", real_number(count / 1e9, 2)),
    }
}

/// Formats a time in seconds as milliseconds.
pub(super) fn milliseconds_text(seconds: f64) -> String {
    let value = 1e3 * seconds;
    let digits = match value.abs() {
        0.0..0.01 => 4,
        0.01..0.1 => 3,
        _ => 2,
    };
    format!("{} ms", real_number(value, digits))
}

/// Formats an energy in millijoules.
pub(super) fn millijoules_text(value: f64) -> String {
    format!("{} mJ", real_number(value, if value.abs() < 0.1 { 4 } else { 3 }))
}

/// Returns the figures of the heading. Without a counted frame there are no shares.
pub(super) fn heading_facts(summary: &InferenceSummary) -> Vec<HeadingFigure> {
    // A value is not broken across lines.
    let whole = |value: String| value.replace(' ', "\u{a0}").replace('-', "\u{2011}");
    let fact = |name, value, note: String| HeadingFigure { name, value: whole(value), note };
    let mut facts = Vec::new();
    if summary.counted_frames > 0 {
        let (macs, active) = (&summary.macs, share_text(summary.active_share));
        let (dense, time) =
            (large_count_text(macs.whole_frame), milliseconds_text(summary.seconds_per_frame));
        facts.extend([
            fact("MACs needed", share_text(macs.needed_share()), format!("of {dense} per frame")),
            fact("MACs computed", share_text(macs.scheduled_share()), "whole blocks".to_owned()),
            fact("Regions changed", share_text(summary.changed_share), format!("{active} active")),
            fact("Time per frame", time, "on this computer".to_owned()),
        ]);
        facts.extend(summary.accelerator.as_ref().map(|found| {
            let [masked, all] =
                [found.masked, found.whole].map(|cost| millijoules_text(cost.energy_mj));
            fact("Energy per frame", masked, format!("whole {all}"))
        }));
        facts.extend(summary.error.map(|found| {
            let psnr = decibels_text(found.outputs.psnr);
            fact(
                "Relative RMS error",
                error_text(found.outputs.relative_rms),
                format!("PSNR {psnr}"),
            )
        }));
    }
    let (frames, counted) = (grouped(summary.frames), grouped(summary.counted_frames));
    facts.push(fact("Frames", frames, format!("{counted} counted")));
    facts.push(fact("Frame", format!("{}×{}", summary.width, summary.height), "pixels".to_owned()));
    facts
}

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
    let x = PlotAxis::always_linear(xs().chain((is_tuning || !is_joined).then_some(0.0)));
    let y = match is_tuning {
        true => PlotAxis::starting_at_zero(ys()),
        false => PlotAxis::always_linear(ys().chain([0.0])),
    };
    let field = PlotAxes { x, y };
    // The axis of the tuning plot has no room for the words of the chart.
    let y_title = if is_tuning { "error [% of variation]" } else { &drawn.chart.y_title };
    let Chart { file_stem, title, x_title, .. } = &drawn.chart;
    let mut plot = PagePlot::new(file_stem, title, &field, [x_title, y_title]);
    if is_frames {
        plot.note = note.to_owned();
    }
    if !is_tuning && is_joined {
        // Numbers of layers and frames are whole.
        plot.x_ticks.retain(|tick| !tick.label.contains('.'));
    }
    for (line, ids) in lines.iter().zip(&drawn.ids) {
        let points = line.points.iter().zip(ids).map(|(&(x, y), id)| {
            let title = titles.get(id.as_str()).copied().unwrap_or_default().to_owned();
            (x, y, PlotMark { id: id.clone(), title, ..PlotMark::default() })
        });
        plot.push_line(&field, line.name.clone(), is_joined, points);
    }
    let is_many = lines.iter().any(|line| line.points.len() > MAX_LARGE_MARKS);
    nest_marks(&mut plot.marks, if is_many { 0.5 } else { 1.0 });
    plot
}

struct DetectionBox {
    /// The fate of the detection, as a CSS class and in words: `kept`, `lost` or `added`.
    class: &'static str,
    x: String,
    y: String,
    width: String,
    height: String,
    title: String,
}

struct FramePicture {
    title: String,
    /// The receiver's screen as a PNG in base64.
    png: String,
    marks: Vec<DetectionBox>,
}

#[derive(Template)]
#[template(path = "shots.html")]
pub(super) struct FramePictures {
    width: u32,
    height: u32,
    /// The width of a line in pixels of the frame.
    line: String,
    pictures: Vec<FramePicture>,
}

pub(super) fn frame_pictures(shots: &KeptScreens) -> Result<Option<FramePictures>, PageError> {
    if shots.screens().is_empty() {
        return Ok(None);
    }
    let (width, height) = shots.size();
    let picture = |shot: &KeptScreen| {
        let failed = |error: image::ImageError| PageError {
            page: shot.name.clone(),
            problem: error.to_string(),
        };
        let png = shots.png_base64(shot).map_err(failed)?;
        Ok(FramePicture { title: picture_title(shot), png, marks: detection_boxes(shot) })
    };
    let pictures = shots.screens().iter().map(picture).collect::<Result<_, PageError>>()?;
    let line = format!("{:.1}", f64::from(width.max(height)) / 300.0);
    Ok(Some(FramePictures { width, height, line, pictures }))
}

fn picture_title(shot: &KeptScreen) -> String {
    let found = shot.detection_counts();
    format!(
        "{}, frame {} ({}): {} kept, {} lost, {} added",
        shot.clip,
        shot.number,
        shot.name,
        found.kept,
        found.whole - found.kept,
        found.added
    )
}

/// Returns the boxes of a frame. Lost and added detections are drawn above those that are kept.
fn detection_boxes(shot: &KeptScreen) -> Vec<DetectionBox> {
    let whole = shot.pairs.whole.iter();
    let kept = whole.clone().filter(|(_, both)| *both).map(|(one, _)| detection_box("kept", one));
    let lost = whole.filter(|(_, both)| !both).map(|(one, _)| detection_box("lost", one));
    let seen = shot.pairs.seen.iter();
    let added = seen.filter(|(_, both)| !both).map(|(one, _)| detection_box("added", one));
    kept.chain(lost).chain(added).collect()
}

fn detection_box(class: &'static str, one: &Detection) -> DetectionBox {
    let text = |value: f64| format!("{value:.1}");
    DetectionBox {
        class,
        x: text(one.rect.x0),
        y: text(one.rect.y0),
        width: text(one.rect.width()),
        height: text(one.rect.height()),
        title: format!("{class}: class {}, score {:.2}", one.class, one.score),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_the_unit_that_fits() {
        assert_eq!(
            [0, 999, 7_824_000, 4_000_000_000].map(bytes_text).join(", "),
            "0 bytes, 999 bytes, 7.8 MB, 4.00 GB"
        );
        assert_eq!(
            [0.0, 312.0, 14_700.0, 140_894_208.0, 4.1e9].map(large_count_text).join(", "),
            "0, 312, 0.015 M, 140.9 M, 4.10 G"
        );
        assert_eq!([0.0, 0.012_34, f64::NAN].map(error_text).join(", "), "0, 1.23e-2, –");
        assert_eq!(
            [None, Some(41.23), Some(f64::NAN)].map(decibels_text).join(", "),
            "infinite, 41.2 dB, –"
        );
        assert_eq!(
            [0.001_19, 0.000_06, 0.000_002].map(milliseconds_text).join(", "),
            "1.19 ms, 0.060 ms, 0.0020 ms"
        );
    }
}
