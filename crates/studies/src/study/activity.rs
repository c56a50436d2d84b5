// SPDX-License-Identifier: MIT OR Apache-2.0
//! The active, SRS and TRS shares over time, with one line per clip.

use std::slice::from_ref;

use super::{Study, clips_only};
use foveate_pictures::chart::{Chart, Line, Shape};

use crate::StudyError;
use crate::findings::Findings;
use crate::number::{percent, share};
use crate::table::Table;
use crate::tally::Regions;
use crate::watch::Watcher;

const COLUMNS: [&str; 6] = ["clip", "frame", "t_us", "active_share", "srs_share", "trs_share"];

type Series = Vec<(u64, Regions)>;

/// A chart: its file name, the description of the regions, and their number in a frame.
type View = (&'static str, &'static str, fn(&Regions) -> u64);

const VIEWS: [View; 3] = [
    ("activity", "active (SRS and TRS)", |frame| frame.active),
    ("activity-srs", "relevant (SRS)", |frame| frame.srs),
    ("activity-trs", "changed (TRS)", |frame| frame.trs),
];

pub(crate) fn run(watcher: &Watcher<'_>) -> Result<Findings, StudyError> {
    let watched = watcher.watch(from_ref(watcher.config), |series: &mut Series, _, seen| {
        series.push((seen.time_us, Regions::of(seen)));
    })?;
    clips_only(Study::Activity, &watched)?;
    let mut table = Table::new(&COLUMNS);
    for clip in &watched {
        let series = clip.points.iter().flat_map(|(_, series)| series);
        for (frame, (time_us, regions)) in series.enumerate() {
            let shares = [regions.active, regions.srs, regions.trs];
            let mut row = vec![clip.name.clone(), frame.to_string(), time_us.to_string()];
            row.extend(shares.map(|part| share(part, regions.all)));
            table.rows.push(row);
        }
    }
    let mut findings = Findings::new(Study::Activity, &watched, table);
    for (file, what, part) in VIEWS {
        let lines = watched.iter().map(|clip| Line {
            name: clip.name.clone(),
            // Frame 0 has no reference. It would set the scale of the axis and has no meaning.
            points: clip
                .points
                .iter()
                .flat_map(|(_, series)| series.iter().skip(1))
                .map(|(time_us, regions)| (seconds(*time_us), percent(part(regions), regions.all)))
                .collect(),
            ..Line::default()
        });
        let chart = Chart {
            file: file.to_owned(),
            title: format!("Regions that are {what}"),
            x: "time since the first frame [s]".to_owned(),
            y: "share of regions [%]".to_owned(),
            caption: String::new(),
            shape: Shape::Lines(lines.collect()),
        };
        findings.chart(chart, &watched);
    }
    Ok(findings)
}

#[allow(clippy::cast_precision_loss, reason = "a coordinate of a chart")]
fn seconds(time_us: u64) -> f64 {
    time_us as f64 / 1e6
}
