// SPDX-License-Identifier: MIT OR Apache-2.0
//! The active, SRS and TRS shares over time, with one line per clip.

use foveate_output::report::ReportTable;
use std::slice::from_ref;

use super::{Study, refuse_data_sets};
use foveate_output::chart::{Chart, ChartData, ChartSeries};

use crate::studies::StudyError;
use crate::studies::findings::StudyFindings;
use crate::studies::number::{percent, share_text};
use crate::studies::runner::StudyRunner;
use crate::studies::tally::RegionCounts;

const COLUMNS: [&str; 6] = ["clip", "frame", "t_us", "active_share", "srs_share", "trs_share"];

type ActivitySeries = Vec<(u64, RegionCounts)>;

/// A chart: its file name, the description of the regions, and their number in a frame.
type ActivityChart = (&'static str, &'static str, fn(&RegionCounts) -> u64);

const VIEWS: [ActivityChart; 3] = [
    ("activity", "active (SRS and TRS)", |frame| frame.active),
    ("activity-srs", "relevant (SRS)", |frame| frame.srs),
    ("activity-trs", "changed (TRS)", |frame| frame.trs),
];

pub(crate) fn run(watcher: &StudyRunner<'_>) -> Result<StudyFindings, StudyError> {
    let watched =
        watcher.run_clips(from_ref(watcher.config), |series: &mut ActivitySeries, _, seen| {
            series.push((seen.time_us, RegionCounts::of_frame(seen)));
        })?;
    refuse_data_sets(Study::Activity, &watched)?;
    let mut table = ReportTable::of_words(COLUMNS);
    for clip in &watched {
        let series = clip.points.iter().flat_map(|(_, series)| series);
        for (frame, (time_us, regions)) in series.enumerate() {
            let shares = [regions.active, regions.srs, regions.trs];
            let mut row = vec![clip.name.clone(), frame.to_string(), time_us.to_string()];
            row.extend(shares.map(|part| share_text(part, regions.all)));
            table.rows.push(row);
        }
    }
    let mut findings = StudyFindings::new(Study::Activity, &watched, table);
    for (file, what, part) in VIEWS {
        let lines = watched.iter().map(|clip| ChartSeries {
            name: clip.name.clone(),
            // Frame 0 has no reference. It would set the scale of the axis and has no meaning.
            points: clip
                .points
                .iter()
                .flat_map(|(_, series)| series.iter().skip(1))
                .map(|(time_us, regions)| (seconds(*time_us), percent(part(regions), regions.all)))
                .collect(),
            ..ChartSeries::default()
        });
        let chart = Chart {
            file_stem: file.to_owned(),
            title: format!("Regions that are {what}"),
            x_title: "time since the first frame [s]".to_owned(),
            y_title: "share of regions [%]".to_owned(),
            caption: String::new(),
            shape: ChartData::Lines(lines.collect()),
        };
        findings.add_chart(chart, &watched);
    }
    Ok(findings)
}

#[allow(clippy::cast_precision_loss, reason = "a coordinate of a chart")]
fn seconds(time_us: u64) -> f64 {
    time_us as f64 / 1e6
}
