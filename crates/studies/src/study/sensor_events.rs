// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file of a real event sensor: a table as CSV, or EVT 2.0, EVT 3.0 or AEDAT4. All may be packed with
//! gzip.

use std::fs::File;
use std::io::BufRead;
use std::path::Path;

use csv::{ErrorKind, ReaderBuilder, StringRecord, Trim};
use foveate_eventfiles::{EventReader, is_event_file};
use foveate_reading::{table_reader, unpacked};
use serde::Deserialize;

/// An event of a sensor. A table may have other columns, too.
#[derive(Deserialize)]
pub(super) struct SensorEvent {
    /// The time in microseconds.
    #[serde(alias = "t")]
    pub(super) t_us: u64,
    /// The column of the pixel.
    pub(super) x: u64,
    /// The row of the pixel.
    pub(super) y: u64,
}

/// Calls `take` with every event of a file. Returns the width and height of the sensor, if the file
/// states them, or the problem if it cannot be read.
pub(super) fn read_sensor_events(
    path: &Path,
    take: impl FnMut(SensorEvent),
) -> Result<Option<(u32, u32)>, String> {
    let input = File::open(path).and_then(unpacked);
    let mut input = input.map_err(|error| error.to_string())?;
    let start = input.fill_buf().map_err(|error| error.to_string())?;
    // A table begins with the name of a column.
    if is_event_file(start) {
        return read_stream(input, take);
    }
    read_table(input, take).map(|()| None)
}

fn read_stream(
    input: impl BufRead,
    mut take: impl FnMut(SensorEvent),
) -> Result<Option<(u32, u32)>, String> {
    let mut events = EventReader::open(input).map_err(|error| error.to_string())?;
    for event in &mut events {
        let event = event.map_err(|error| error.to_string())?;
        take(SensorEvent { t_us: event.time_us, x: event.x.into(), y: event.y.into() });
    }
    Ok(events.size())
}

fn read_table(input: impl BufRead, mut take: impl FnMut(SensorEvent)) -> Result<(), String> {
    let mut table = table_reader(ReaderBuilder::new().flexible(true).trim(Trim::All), input);
    let columns = table.headers().map_err(|error| table_problem(&error))?.clone();
    let event = |record: StringRecord| record.deserialize(Some(&columns));
    for record in table.records() {
        take(record.and_then(event).map_err(|error| table_problem(&error))?);
    }
    Ok(())
}

/// Returns the problem, with the number of its line.
fn table_problem(error: &csv::Error) -> String {
    match (error.kind(), error.position()) {
        (ErrorKind::Deserialize { err, .. }, Some(place)) => {
            format!("line {}: {err}", place.line())
        }
        _ => error.to_string(),
    }
}
