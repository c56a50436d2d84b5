// SPDX-License-Identifier: MIT OR Apache-2.0
//! The correlation of the model with a real event sensor: the rank correlation, over regions, of
//! the model's counts with the numbers of events that the sensor sent at the same time.

use std::path::Path;
use std::slice::from_ref;

use foveate_design::Design;

use super::sensor_events::{SensorEvent, read_sensor_events};
use super::{Study, refuse_data_sets};
use crate::StudyError;
use crate::findings::StudyFindings;
use crate::rank::spearman;
use crate::runner::StudyRunner;
use crate::table::StudyTable;

const COLUMNS: [&str; 5] = ["count_per_region", "spearman", "regions", "sensor_events", "design"];

/// The counts per region over all frames but the first, which has no reference.
#[derive(Default)]
struct ModelCounts {
    active: Vec<u64>,
    changed: Vec<u64>,
    pixels: Vec<u64>,
    last_us: u64,
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
    let watched =
        watcher.run_clips(from_ref(watcher.config), |counts: &mut ModelCounts, _, seen| {
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
        })?;
    refuse_data_sets(Study::Sensor, &watched)?;
    let mut table = StudyTable::new(&COLUMNS);
    for (design, counts) in watched.iter().flat_map(|clip| &clip.points) {
        let times = (start, start.saturating_add(counts.last_us));
        let events =
            read_recording(path, design, times)?.into_events_per_region(path, times, design)?;
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
    findings.notes.push(format!("sensor events {}", path.display()));
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
}

impl SensorRecording {
    /// Returns the number of events of every region. Fails if no event belongs to the clip.
    fn into_events_per_region(
        self,
        path: &Path,
        (first, last): (u64, u64),
        design: &Design,
    ) -> Result<Vec<u64>, StudyError> {
        let wrong = |problem| StudyError::SensorEvents { path: path.to_owned(), problem };
        let (from, to) = self.times.ok_or_else(|| wrong("it holds no event".to_owned()))?;
        if !self.has_events_of_clip {
            let path = path.to_owned();
            return Err(StudyError::SensorTime { path, first, last, from, to });
        }
        if self.per_region.iter().all(|&events| events == 0) {
            let (width, height) = (design.width(), design.height());
            return Err(wrong(format!(
                "all events of that time are outside of the frame of {width}x{height} pixels"
            )));
        }
        Ok(self.per_region)
    }
}

/// Reads a recording. Events with first < t <= last count for their region, unless they are outside
/// of the frame.
fn read_recording(
    path: &Path,
    design: &Design,
    (first, last): (u64, u64),
) -> Result<SensorRecording, StudyError> {
    let per_region = vec![0; design.regions() as usize];
    let mut recorded = SensorRecording { per_region, times: None, has_events_of_clip: false };
    let read = read_sensor_events(path, |event| {
        let SensorEvent { t_us: t, x, y } = event;
        let (from, to) = recorded.times.unwrap_or((t, t));
        recorded.times = Some((from.min(t), to.max(t)));
        let meanwhile = t > first && t <= last;
        recorded.has_events_of_clip |= meanwhile;
        if meanwhile && x < u64::from(design.width()) && y < u64::from(design.height()) {
            let size = u64::from(design.region_size());
            let region = y / size * u64::from(design.columns()) + x / size;
            recorded.per_region[usize::try_from(region).expect("it is in the frame")] += 1;
        }
    });
    let wrong = |problem| StudyError::SensorEvents { path: path.to_owned(), problem };
    read.map(|()| recorded).map_err(wrong)
}
