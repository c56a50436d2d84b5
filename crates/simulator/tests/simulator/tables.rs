// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of regions equals the results of the model in every format, and agrees with the arrays
//! and the summary.

use crate::support;
use std::fs::{self, File};
use std::path::Path;

use crate::packets::FLOW_DESIGN;
use crate::support::{NpyArray, STREET, outcomes, street};
use foveate_simulator::{EventTableOptions, RunOptions, RunSummary};
use parquet::basic::Type;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

const HEADING: &str = "frame,t_us,x,y,x0,y0,srs,trs,score_edge,score_mad,t_count,action";

fn simulate(output: &Path, tables: EventTableOptions) -> RunSummary {
    street(output, &STREET, &RunOptions { events: tables, rendered: None, ..RunOptions::default() })
}

/// Returns the table that follows from the model.
fn expected(only_active: bool) -> Vec<String> {
    let mut lines = Vec::new();
    for (frame, (outcome, time)) in
        outcomes(&STREET).iter().zip([0, 33_333, 66_667, 100_000, 133_333]).enumerate()
    {
        for region in 0..30 {
            let (x, y) = (region % 6, region / 6);
            let bit = |bits: &[bool]| u8::from(bits[region]);
            let action = match (outcome.srs[region], outcome.trs[region]) {
                (true, true) => "forward",
                (true, false) => "hold",
                (false, _) => "blank",
            };
            if only_active && action != "forward" {
                continue;
            }
            lines.push(format!(
                "{frame},{time},{x},{y},{},{},{},{},{},{},{},{action}",
                8 * x,
                8 * y,
                bit(&outcome.srs),
                bit(&outcome.trs),
                outcome.scores[0][region],
                outcome.scores[1][region],
                outcome.temporal_count[region],
            ));
        }
    }
    lines
}

/// Returns a Parquet file as the lines of the CSV file.
fn parquet_lines(path: &Path) -> (String, Vec<String>) {
    let reader = SerializedFileReader::new(File::open(path).unwrap()).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let names: Vec<&str> = schema.columns().iter().map(|column| column.name()).collect();
    let text = |field: &Field| match field {
        Field::Bool(value) => u8::from(*value).to_string(),
        Field::Str(value) => value.clone(),
        other => other.to_string(),
    };
    let lines = reader.get_row_iter(None).unwrap().map(|row| {
        let row = row.unwrap();
        row.get_column_iter().map(|(_, field)| text(field)).collect::<Vec<_>>().join(",")
    });
    (names.join(","), lines.collect())
}

#[test]
fn csv_and_parquet_hold_every_region_of_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    simulate(&output, EventTableOptions { csv: true, parquet: true, only_active: false });
    let csv = fs::read_to_string(output.join("events.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some(HEADING));
    let lines: Vec<&str> = lines.collect();
    assert_eq!(lines, expected(false));
    let (heading, rows) = parquet_lines(&output.join("events.parquet"));
    assert_eq!(heading, HEADING);
    assert_eq!(rows, lines);
}

#[test]
fn only_active_regions_agree_with_arrays_and_summary() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let summary =
        simulate(&output, EventTableOptions { csv: true, parquet: true, only_active: true });
    let (_, rows) = parquet_lines(&output.join("events.parquet"));
    assert_eq!(rows, expected(true));
    let csv = fs::read_to_string(output.join("events.csv")).unwrap();
    assert_eq!(csv.lines().skip(1).collect::<Vec<_>>(), rows);
    let active = NpyArray::read(&output.join("active.npy"));
    let set = active.data.iter().filter(|&&bit| bit == 1).count();
    assert_eq!(rows.len(), set);
    assert_eq!(summary.bandwidth.region.events, Some(set as u64));
    for row in &rows {
        let numbers: Vec<usize> = row.split(',').filter_map(|field| field.parse().ok()).collect();
        assert_eq!(active.data[(numbers[0] * 5 + numbers[3]) * 6 + numbers[2]], 1, "{row}");
    }
}

#[test]
fn parquet_columns_have_plain_types() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    simulate(&output, EventTableOptions { parquet: true, ..EventTableOptions::default() });
    assert!(!output.join("events.csv").exists());
    let file = File::open(output.join("events.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    for column in schema.columns() {
        let expected = match column.name() {
            "frame" | "t_us" | "score_edge" | "score_mad" => Type::INT64,
            "srs" | "trs" => Type::BOOLEAN,
            "action" => Type::BYTE_ARRAY,
            _ => Type::INT32,
        };
        assert_eq!(column.physical_type(), expected, "{}", column.name());
        assert_eq!(column.max_def_level(), 0, "{} is never missing", column.name());
    }
}

/// The displacement of a region has six bits in a search of radius 2.
#[test]
fn displacements_have_columns_and_count_as_sent() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let events = EventTableOptions { csv: true, parquet: true, only_active: false };
    let options = RunOptions { events, rendered: None, ..RunOptions::default() };
    let summary = street(&output, FLOW_DESIGN, &options);
    let (heading, rows) = parquet_lines(&output.join("events.parquet"));
    let expected = "frame,t_us,x,y,x0,y0,srs,trs,score_edge,score_flow,t_count,dx,dy,action";
    assert_eq!(heading, expected);
    let csv = fs::read_to_string(output.join("events.csv")).unwrap();
    assert_eq!(csv.lines().collect::<Vec<_>>(), [&[heading][..], &rows].concat());
    let outcomes = outcomes(FLOW_DESIGN);
    let displacements = outcomes.iter().flat_map(|outcome| &outcome.displacements);
    assert_eq!(rows.len(), displacements.clone().count());
    for (row, displacement) in rows.iter().zip(displacements) {
        let fields: Vec<&str> = row.split(',').collect();
        assert_eq!(fields[11..13], [displacement.dx.to_string(), displacement.dy.to_string()]);
    }
    let bits = 5 * 30 * (2 + 6) + summary.pixels_forwarded * 8;
    assert_eq!(summary.bandwidth.region.bytes, bits.div_ceil(8));
}

#[test]
fn bytes_are_those_that_the_outcomes_need() {
    let folder = tempfile::tempdir().unwrap();
    let overrides = [&STREET[..], &["frame.pixel_bits=10"]].concat();
    let summary = street(&folder.path().join("out"), &overrides, &RunOptions::default());
    let bandwidth = &summary.bandwidth;
    // The clip has 5 frames of 45 x 38 pixels of 10 bits, and 30 regions with 2 bits each.
    assert_eq!(bandwidth.raw.bytes, (5 * 45 * 38 * 10u64).div_ceil(8));
    let bits = 5 * 30 * 2 + summary.pixels_forwarded * 10;
    assert_eq!(bandwidth.region.bytes, bits.div_ceil(8));
    assert_eq!(bandwidth.duration_us, Some(166_666));
    assert!(bandwidth.pixel.is_none());
    let rate = bandwidth.region.bytes_per_second.unwrap();
    #[allow(clippy::cast_precision_loss, reason = "small numbers")]
    let expected = bandwidth.region.bytes as f64 / 0.166_666;
    assert!((rate - expected).abs() < 0.06, "{rate} {expected}");
}

#[test]
fn a_single_frame_has_no_rates() {
    let folder = tempfile::tempdir().unwrap();
    let image = support::grey(&folder.path().join("a.png"), 9, 9, |x, _| u8::try_from(x).unwrap());
    let output = folder.path().join("out");
    let summary = support::run(&[image], &[], &output, &RunOptions::default()).unwrap();
    assert_eq!(summary.bandwidth.duration_us, None);
    assert_eq!(summary.bandwidth.raw.bytes_per_second, None);
    assert_eq!(summary.bandwidth.region.events_per_second, None);
}
