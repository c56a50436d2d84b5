// SPDX-License-Identifier: MIT OR Apache-2.0
//! The format of `gt.txt` of MOT16, MOT17 and MOT20: one row per object and frame, without a
//! header.
//!
//! The columns are frame, track, left, top, width, height, counted, class and visibility. Frames
//! and coordinates begin at 1. A row is an object if it is counted (not 0), its class is 1
//! (pedestrian), and at least a quarter of it is visible; an object that cannot be seen says
//! nothing about a camera.

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};

use super::field::{error_in_line, parse_numbers, parse_whole, unreadable_record};
use crate::boxes::exclusions::BoxExclusions;
use crate::boxes::limits::{self, MAX_BOXES};
use crate::boxes::{BoxError, LabelledBox};
use foveate_pixels::Rect;

const COLUMNS: [&str; 9] =
    ["frame", "track", "left", "top", "width", "height", "counted", "class", "visibility"];
const PEDESTRIAN: f64 = 1.0;
const LEAST_VISIBLE: f64 = 0.25;

/// Reads the objects of every frame that has a row, by the number of the frame, and counts the rows
/// that are no objects.
pub(crate) fn read(
    path: &Path,
    left_out: &mut BoxExclusions,
) -> Result<BTreeMap<u64, Vec<LabelledBox>>, BoxError> {
    let mut file = foveate_tools::table_reader(
        ReaderBuilder::new().has_headers(false).flexible(true).trim(Trim::All),
        limits::open(path)?,
    );
    let mut frames: BTreeMap<u64, Vec<LabelledBox>> = BTreeMap::new();
    let mut seen = HashSet::new();
    for record in file.records() {
        let record = record.map_err(|error| unreadable_record(path, error))?;
        let wrong = |problem| error_in_line(path, &record, problem);
        if seen.len() == MAX_BOXES {
            return Err(wrong(limits::too_many_boxes()));
        }
        let row = parse_row(&record).map_err(wrong)?;
        if !seen.insert((row.frame, row.track)) {
            let MotRow { frame, track, .. } = row;
            return Err(wrong(format!("track {track} has a second box in frame {frame}")));
        }
        let objects = frames.entry(row.frame).or_default();
        left_out.count(row.left_out);
        if row.left_out.is_none() {
            objects.push(LabelledBox { rect: row.rect, track: Some(row.track) });
        }
    }
    Ok(frames)
}

struct MotRow {
    frame: u64,
    track: u64,
    rect: Rect,
    /// The reason why the row is no object.
    left_out: Option<&'static str>,
}

fn parse_row(record: &StringRecord) -> Result<MotRow, String> {
    let fields: Vec<&str> = record.iter().collect();
    let Ok([frame, track, left, top, width, height, counted, class, visibility]) =
        <[&str; COLUMNS.len()]>::try_from(fields)
    else {
        let (columns, names) = (record.len(), COLUMNS.join(", "));
        return Err(format!("the row has {columns} columns; expected {}: {names}", COLUMNS.len()));
    };
    let frame = parse_whole("frame", frame, 1)?;
    let track = parse_whole("track", track, 0)?;
    let names = [COLUMNS[2], COLUMNS[3], COLUMNS[4], COLUMNS[5]];
    let [left, top, width, height] = parse_numbers(names, [left, top, width, height])?;
    let names = [COLUMNS[6], COLUMNS[7], COLUMNS[8]];
    let [counted, class, visible] = parse_numbers(names, [counted, class, visibility])?;
    let rect = Rect::from_corner_and_size([left - 1.0, top - 1.0, width, height])?;
    let left_out = if class != PEDESTRIAN {
        Some("of another class than 1 (pedestrian)")
    } else if counted == 0.0 {
        Some("not to be counted (flag 0)")
    } else if visible < LEAST_VISIBLE {
        Some("visible by less than a quarter")
    } else {
        None
    };
    Ok(MotRow { frame, track, rect, left_out })
}
