// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file of a real event sensor: a table as CSV, or EVT 2.0, EVT 3.0 or AEDAT4. All may be packed with
//! gzip.

use std::io::BufRead;
use std::path::Path;

use csv::{ErrorKind, ReaderBuilder, StringRecord, Trim};
use foveate_media::{EventReader, is_event_file};
use foveate_tools::{foreign_format, open_file, table_reader, unpacked};
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
    let input = open_file(path).and_then(unpacked);
    let mut input = input.map_err(|error| error.to_string())?;
    let start = input.fill_buf().map_err(|error| error.to_string())?;
    // A table begins with the name of a column.
    if is_event_file(start) {
        return read_stream(input, take);
    }
    if let Some(what) = foreign_format(start) {
        return Err(format!("it is {what}; write its events as a table first"));
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
    if let Some(problem) = columns_problem(&columns) {
        return Err(problem);
    }
    let event = |record: StringRecord| record.deserialize(Some(&columns));
    for record in table.records() {
        take(record.and_then(event).map_err(|error| table_problem(&error))?);
    }
    Ok(())
}

/// Returns the problem of a first line that does not name the columns.
fn columns_problem(columns: &StringRecord) -> Option<String> {
    let has = |names: &[&str]| columns.iter().any(|column| names.contains(&column));
    if has(&["t", "t_us"]) && has(&["x"]) && has(&["y"]) {
        return None;
    }
    let line: String = columns.iter().collect::<Vec<_>>().join(",").chars().take(80).collect();
    let has_no_names =
        |separators: &[char]| line.split(separators).all(|word| word.parse::<f64>().is_ok());
    Some(if line.starts_with('#') || has_no_names(&[' ', '\t']) {
        "its columns have no names, as in the text of v2e; make a table with times in microseconds, for example with \
         `awk 'BEGIN { print \"t,x,y\" } !/^#/ { printf \"%d,%d,%d\\n\", $1 * 1000000, $2, $3 }' EVENTS.txt`"
            .to_owned()
    } else if has_no_names(&[',']) {
        "its columns have no names; put a line with them before it, such as `t,x,y`".to_owned()
    } else {
        format!("its first line, `{line}`, does not name these columns")
    })
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
