// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of a comparison.

use foveate_output::tables::{NamedCells, Table, TableCell, named_cells};
use foveate_tools::StagedFolder;

use super::frame_ranges::frame_ranges;
use super::report::charts;
use crate::link::{
    ClipReport, CurvePoint, LinkError, LinkReport, Quality, SenderReport, UnbufferedFigures,
};

pub(crate) fn write(staging: &StagedFolder, report: &LinkReport) -> Result<(), LinkError> {
    let senders = |clip: &ClipReport| -> Vec<NamedCells> {
        clip.senders.iter().map(|sender| sender_row(clip, sender)).collect()
    };
    let points = |clip: &ClipReport| -> Vec<NamedCells> {
        clip.curves.iter().map(|point| point_row(clip, point)).collect()
    };
    let senders = Table::from_rows(report.clips.iter().flat_map(senders));
    let points = Table::from_rows(report.clips.iter().flat_map(points));
    staging.write("link.csv", senders.to_csv().as_bytes())?;
    staging.write("link.parquet", &parquet(&senders, "link.parquet")?)?;
    staging.write("rate-distortion.csv", points.to_csv().as_bytes())?;
    staging.write("rate-distortion.parquet", &parquet(&points, "rate-distortion.parquet")?)?;
    let json = serde_json::to_vec_pretty(report).expect("a report has no keys that are not text");
    staging.write("link.json", &json)?;
    for (number, clip) in report.clips.iter().enumerate() {
        // The name of a clip may not be usable in a file name, so the files are numbered.
        let of_clip = if report.clips.len() == 1 { String::new() } else { format!("-{number}") };
        for chart in charts(clip, &of_clip) {
            let notes = [chart.caption.clone(), format!("inputs {}", clip.inputs.join(" "))];
            staging.write(&format!("{}.svg", chart.file_stem), chart.to_svg(&notes)?.as_bytes())?;
            staging.write(&format!("{}.png", chart.file_stem), &chart.to_png()?)?;
        }
    }
    Ok(())
}

fn parquet(table: &Table, name: &'static str) -> Result<Vec<u8>, LinkError> {
    table.to_parquet("link").map_err(|source| LinkError::Table { name, source })
}

fn sender_row(clip: &ClipReport, sender: &SenderReport) -> NamedCells {
    let figures = &sender.figures;
    let mut row = named_cells([
        ("clip", clip.name.as_str().into()),
        ("sender", sender.sender.into()),
        ("equal", sender.equal.unwrap_or_default().into()),
        ("quantizer", TableCell::Count(sender.quantizer.map(u64::from))),
        ("found", sender.search_result.unwrap_or_default().into()),
    ]);
    row.extend(quality_cells(sender.quality));
    row.extend(named_cells([
        ("bytes", figures.bytes.into()),
        ("bytes_per_second", figures.bytes_per_second.into()),
    ]));
    for rates in &figures.windows {
        let name = |what| format!("{what}_{}ms", rates.window_ms);
        row.push((name("p99"), rates.p99.into()));
        row.push((name("peak"), rates.peak.into()));
    }
    row.extend(named_cells([
        ("largest_frame_bytes", figures.largest_frame_bytes.into()),
        ("decision_ns", figures.decision_ns.into()),
        ("delivery_median_ns", figures.delivery_ns.median.into()),
        ("delivery_p99_ns", figures.delivery_ns.p99.into()),
        ("delivery_longest_ns", figures.delivery_ns.longest.into()),
        ("buffer_bytes", figures.buffer_bytes.into()),
        ("overloaded", TableCell::Flag(figures.overloaded)),
    ]));
    row.extend(unbuffered_cells(sender.unbuffered.as_ref()));
    row.extend(named_cells([("design", clip.design.as_str().into())]));
    row
}

/// Returns the figures without a buffer, which are empty for all senders but a raster core.
fn unbuffered_cells(figures: Option<&UnbufferedFigures>) -> NamedCells {
    let frames = figures.map(|figures| frame_ranges(&figures.frames_with_losses));
    named_cells([
        ("unbuffered_clock_hz", TableCell::Count(figures.map(|figures| figures.clock_hz))),
        ("unbuffered_lost_regions", TableCell::Count(figures.map(|figures| figures.lost_regions))),
        ("unbuffered_frames_with_losses", TableCell::Text(frames.unwrap_or_default())),
        ("unbuffered_last_word_ns", TableCell::Count(figures.map(|figures| figures.last_word_ns))),
    ])
}

fn point_row(clip: &ClipReport, point: &CurvePoint) -> NamedCells {
    let mut row = named_cells([
        ("clip", clip.name.as_str().into()),
        ("sender", point.sender.into()),
        ("knob", point.setting.into()),
        ("value", point.value.into()),
        ("bytes_per_second", point.bytes_per_second.into()),
    ]);
    row.extend(quality_cells(Some(point.quality)));
    row
}

fn quality_cells(quality: Option<Quality>) -> NamedCells {
    named_cells([
        ("psnr", TableCell::Real(quality.and_then(|quality| quality.psnr))),
        ("ssim", TableCell::Real(quality.map(|quality| quality.ssim))),
    ])
}
