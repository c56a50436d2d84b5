// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of a comparison.

use foveate_files::tables::{Cell, Cells, Table};
use foveate_staging::StagedFolder;

use crate::picture::charts;
use crate::{ClipReport, LinkError, LinkReport, Point, Quality, SenderReport};

/// Writes all files.
pub(crate) fn write(staging: &StagedFolder, report: &LinkReport) -> Result<(), LinkError> {
    let senders = |clip: &ClipReport| -> Vec<Cells> {
        clip.senders.iter().map(|sender| sender_row(clip, sender)).collect()
    };
    let points = |clip: &ClipReport| -> Vec<Cells> {
        clip.curves.iter().map(|point| point_row(clip, point)).collect()
    };
    let senders = Table::of(report.clips.iter().flat_map(senders));
    let points = Table::of(report.clips.iter().flat_map(points));
    staging.write("link.csv", senders.csv().as_bytes())?;
    staging.write("link.parquet", &parquet(&senders, "link.parquet")?)?;
    staging.write("rate-distortion.csv", points.csv().as_bytes())?;
    staging.write("rate-distortion.parquet", &parquet(&points, "rate-distortion.parquet")?)?;
    let json = serde_json::to_vec_pretty(report).expect("a report has no keys that are not text");
    staging.write("link.json", &json)?;
    for (number, clip) in report.clips.iter().enumerate() {
        // The name of a clip may not be usable in a file name, so the files are numbered.
        let of_clip = if report.clips.len() == 1 { String::new() } else { format!("-{number}") };
        for chart in charts(clip, &of_clip) {
            let notes = [chart.caption.clone(), format!("inputs {}", clip.inputs.join(" "))];
            staging.write(&format!("{}.svg", chart.file), chart.svg(&notes)?.as_bytes())?;
            staging.write(&format!("{}.png", chart.file), &chart.png()?)?;
        }
    }
    Ok(())
}

fn parquet(table: &Table, name: &'static str) -> Result<Vec<u8>, LinkError> {
    table.parquet("link").map_err(|source| LinkError::Table { name, source })
}

fn sender_row(clip: &ClipReport, sender: &SenderReport) -> Cells {
    let figures = &sender.figures;
    let text = |text: Option<&str>| Cell::Text(text.unwrap_or_default().to_owned());
    let mut row = named([
        ("clip", Cell::Text(clip.name.clone())),
        ("sender", Cell::Text(sender.sender.to_owned())),
        ("equal", text(sender.equal)),
        ("quantizer", Cell::Count(sender.quantizer.map(u64::from))),
        ("found", text(sender.found)),
    ]);
    row.extend(quality_cells(sender.quality));
    row.extend(named([
        ("bytes", Cell::Count(Some(figures.bytes))),
        ("bytes_per_second", Cell::Count(Some(figures.bytes_per_second))),
    ]));
    for rates in &figures.windows {
        let name = |what| format!("{what}_{}ms", rates.window_ms);
        row.push((name("p99"), Cell::Count(Some(rates.p99))));
        row.push((name("peak"), Cell::Count(Some(rates.peak))));
    }
    row.extend(named([
        ("largest_frame_bytes", Cell::Count(Some(figures.largest_frame_bytes))),
        ("decision_ns", Cell::Count(Some(figures.decision_ns))),
        ("delivery_median_ns", Cell::Count(Some(figures.delivery_ns.median))),
        ("delivery_p99_ns", Cell::Count(Some(figures.delivery_ns.p99))),
        ("delivery_longest_ns", Cell::Count(Some(figures.delivery_ns.longest))),
        ("buffer_bytes", Cell::Count(Some(figures.buffer_bytes))),
        ("overloaded", Cell::Flag(figures.overloaded)),
        ("design", Cell::Text(clip.design.clone())),
    ]));
    row
}

fn point_row(clip: &ClipReport, point: &Point) -> Cells {
    let mut row = named([
        ("clip", Cell::Text(clip.name.clone())),
        ("sender", Cell::Text(point.sender.to_owned())),
        ("knob", Cell::Text(point.knob.to_owned())),
        ("value", Cell::Count(Some(point.value))),
        ("bytes_per_second", Cell::Count(Some(point.bytes_per_second))),
    ]);
    row.extend(quality_cells(Some(point.quality)));
    row
}

fn quality_cells(quality: Option<Quality>) -> Cells {
    named([
        ("psnr", Cell::Real(quality.and_then(|quality| quality.psnr))),
        ("ssim", Cell::Real(quality.map(|quality| quality.ssim))),
    ])
}

fn named<const N: usize>(cells: [(&str, Cell); N]) -> Cells {
    cells.map(|(name, cell)| (name.to_owned(), cell)).into()
}
