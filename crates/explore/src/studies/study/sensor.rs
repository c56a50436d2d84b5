// SPDX-License-Identifier: MIT OR Apache-2.0
//! The correlation of the model with a real event sensor ([`run`]): the rank correlation, over
//! regions, of the model's counts with the numbers of events that the sensor sent at the same
//! time. The events come from a file ([`read_sensor_events`]): a table as CSV, or EVT 2.0, EVT
//! 3.0 or AEDAT4, each perhaps packed with gzip.

use super::{Study, refuse_data_sets};
use crate::studies::StudyError;
use crate::studies::findings::StudyFindings;
use crate::studies::rank::spearman;
use crate::studies::runner::{FrameAnnotator, StudyRunner};
use csv::{ErrorKind, ReaderBuilder, StringRecord, Trim};
use foveate_design::Design;
use foveate_media::boxes::BoxView;
use foveate_media::{CropRect, EventReader, PlaybackError, PlayedFrame, is_event_file};
use foveate_output::report::ReportTable;
use foveate_pixels::Rect;
use foveate_tools::{foreign_format, open_file, table_reader, unpacked};
use serde::Deserialize;
use std::io::BufRead;
use std::path::Path;
use std::slice::from_ref;

const COLUMNS: [&str; 5] = ["count_per_region", "spearman", "regions", "sensor_events", "design"];

/// The counts per region over all frames but the first, which has no reference.
#[derive(Default)]
struct ModelCounts {
    active: Vec<u64>,
    changed: Vec<u64>,
    pixels: Vec<u64>,
    last_us: u64,
}

/// The frame as it was before it was cropped and scaled, and the part of it that the camera sees.
struct SensorView {
    crop: Option<CropRect>,
    /// The width and height of the whole frame, and the transformation from it.
    found: Option<((u32, u32), BoxView)>,
}

impl FrameAnnotator for SensorView {
    fn annotate(&mut self, frame: &PlayedFrame) -> Result<(), PlaybackError> {
        if self.found.is_none() {
            let origin = frame.origin.expect("an input knows where its frames are from");
            let view = BoxView::from_source_frame(frame, &origin, self.crop);
            self.found = Some((origin.size, view));
        }
        Ok(())
    }
}

/// Runs the study. `start` is the time of the first frame on the clock of the events, in
/// microseconds.
pub(crate) fn run(
    watcher: &StudyRunner<'_>,
    events: Option<&Path>,
    start: u64,
) -> Result<StudyFindings, StudyError> {
    let path = events.ok_or(StudyError::NoSensorEvents)?;
    let clips = watcher.clips.clips().len();
    if clips != 1 {
        return Err(StudyError::SeveralClips { clips });
    }
    let crop = watcher.clips.options().crop;
    let watched = watcher.run_annotated_clips(
        from_ref(watcher.config),
        |_| SensorView { crop, found: None },
        |_, counts: &mut ModelCounts, _, seen| {
            let outcome = seen.outcome;
            for (sums, votes) in
                [(&mut counts.active, &outcome.active), (&mut counts.changed, &outcome.trs)]
            {
                sums.resize(votes.len(), 0);
                for (sum, &vote) in sums.iter_mut().zip(votes) {
                    *sum += u64::from(vote && !seen.is_without_reference);
                }
            }
            counts.pixels.resize(outcome.temporal_count.len(), 0);
            for (sum, &count) in counts.pixels.iter_mut().zip(&outcome.temporal_count) {
                *sum += if seen.is_without_reference { 0 } else { u64::from(count) };
            }
            counts.last_us = seen.time_us;
        },
    )?;
    refuse_data_sets(Study::Sensor, &watched)?;
    let mut table = ReportTable::of_words(COLUMNS);
    let mut outside = 0;
    let clip = watched.first().expect("there is one clip");
    let view = clip.annotator.found.as_ref().expect("a clip has a frame");
    for (design, counts) in &clip.points {
        let times = (start, start.saturating_add(counts.last_us));
        let recording = read_recording(path, design, view, times)?;
        outside = recording.outside;
        let events = recording.into_events_per_region(path, times, view.0)?;
        for (name, own) in [
            ("active frames", &counts.active),
            ("frames with TRS", &counts.changed),
            ("changed pixels", &counts.pixels),
        ] {
            table.rows.push(vec![
                name.to_owned(),
                spearman(own, &events).map_or("undefined".to_owned(), |rho| format!("{rho:.4}")),
                design.regions().to_string(),
                events.iter().sum::<u64>().to_string(),
                design.fingerprint(),
            ]);
        }
    }
    let mut findings = StudyFindings::new(Study::Sensor, &watched, table);
    let left_out = match outside {
        0 => String::new(),
        events => format!("; {events} of that time are outside of the frame, left out"),
    };
    findings.notes.push(format!("sensor events {}{left_out}", path.display()));
    Ok(findings)
}

/// The events of a recording that belong to a clip.
struct SensorRecording {
    /// The number of events of every region, in row-major order.
    per_region: Vec<u64>,
    /// The times of the first and the last event of the recording, in microseconds.
    times: Option<(u64, u64)>,
    /// True if some event falls into the time of the clip, inside of the frame or not.
    has_events_of_clip: bool,
    /// True if some event is inside of the frame, at any time.
    has_events_of_frame: bool,
    /// The number of events in the time of the clip that are outside of the frame.
    outside: u64,
}

impl SensorRecording {
    /// Returns the number of events of every region. Fails if no event belongs to the clip.
    fn into_events_per_region(
        self,
        path: &Path,
        (first, last): (u64, u64),
        (width, height): (u32, u32),
    ) -> Result<Vec<u64>, StudyError> {
        let wrong = |problem| StudyError::SensorEvents { path: path.to_owned(), problem };
        let (from, to) = self.times.ok_or_else(|| wrong("it holds no event".to_owned()))?;
        if !self.has_events_of_frame {
            return Err(wrong(format!(
                "all its events are outside of the part that is taken of the frame of {width}x{height} pixels"
            )));
        }
        if !self.has_events_of_clip {
            let path = path.to_owned();
            return Err(StudyError::SensorTime { path, first, last, from, to });
        }
        if self.per_region.iter().all(|&events| events == 0) {
            return Err(wrong(format!(
                "all events of that time are outside of the part that is taken of the frame of {width}x{height} pixels"
            )));
        }
        Ok(self.per_region)
    }
}

/// Reads a recording. Events with first < t <= last count for their region, unless they are outside
/// of the frame. They are cropped and scaled as the frames are.
fn read_recording(
    path: &Path,
    design: &Design,
    &((width, height), view): &((u32, u32), BoxView),
    (first, last): (u64, u64),
) -> Result<SensorRecording, StudyError> {
    let mut recorded = SensorRecording {
        per_region: vec![0; design.regions() as usize],
        times: None,
        has_events_of_clip: false,
        has_events_of_frame: false,
        outside: 0,
    };
    let read = read_sensor_events(path, |SensorEvent { t_us: t, x, y }| {
        let (from, to) = recorded.times.unwrap_or((t, t));
        recorded.times = Some((from.min(t), to.max(t)));
        let meanwhile = t > first && t <= last;
        recorded.has_events_of_clip |= meanwhile;
        match region_of_event(design, view, (x, y)) {
            None => recorded.outside += u64::from(meanwhile),
            Some(region) => {
                recorded.has_events_of_frame = true;
                recorded.per_region[region] += u64::from(meanwhile);
            }
        }
    });
    let wrong = |problem| StudyError::SensorEvents { path: path.to_owned(), problem };
    match read.map_err(wrong)? {
        Some(sensor) if sensor != (width, height) => Err(wrong(format!(
            "its sensor has {}x{} pixels, but the frames of the clip have {width}x{height}; name the clip of the \
             same camera",
            sensor.0, sensor.1
        ))),
        _ => Ok(recorded),
    }
}

/// Returns the region in which the center of an event's pixel lies, after the frame is cropped and
/// scaled.
fn region_of_event(design: &Design, view: BoxView, (x, y): (u64, u64)) -> Option<usize> {
    let side = |place: u64| u32::try_from(place).map(f64::from).ok();
    let (x, y) = (side(x)?, side(y)?);
    let (x, y) = view.transform(&Rect::from_corner_and_size([x, y, 1.0, 1.0]).ok()?).centre();
    let frame = (f64::from(design.width()), f64::from(design.height()));
    let is_inside = (0.0..frame.0).contains(&x) && (0.0..frame.1).contains(&y);
    let region = |place: f64| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is inside")]
        let place = place as u32;
        place / design.region_size()
    };
    is_inside.then(|| (region(y) * design.columns() + region(x)) as usize)
}

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
