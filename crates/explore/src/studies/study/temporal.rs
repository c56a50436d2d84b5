// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shares over whole clips, with a row per clip.

use foveate_output::report::ReportTable;
use std::slice::from_ref;

use foveate_output::{
    chart::{BarSeries, Chart, ChartData},
    palette::{ACTIVE, CHANGED, RELEVANT},
};

use super::{Study, refuse_data_sets};
use crate::studies::StudyError;
use crate::studies::findings::StudyFindings;
use crate::studies::number::{percent, share_text};
use crate::studies::runner::StudyRunner;
use crate::studies::tally::{RegionCounts, RegionTally};

const COLUMNS: [&str; 9] = [
    "clip",
    "frames",
    "regions",
    "active_mean",
    "active_min",
    "active_max",
    "srs_share",
    "trs_share",
    "design",
];

pub(crate) fn run(watcher: &StudyRunner<'_>) -> Result<StudyFindings, StudyError> {
    let watched = watcher
        .run_clips(from_ref(watcher.config), |tally: &mut RegionTally, _, seen| tally.add(seen))?;
    refuse_data_sets(Study::Temporal, &watched)?;
    let mut table = ReportTable::of_words(COLUMNS);
    let mut groups = Vec::new();
    let mut ranges = Vec::new();
    let mut sums = Vec::new();
    for clip in &watched {
        for (design, tally) in &clip.points {
            let (sum, regions) = (tally.sum(), u64::from(design.regions()));
            let (min, max) = tally.extremes();
            table.rows.push(vec![
                clip.name.clone(),
                clip.frames.to_string(),
                regions.to_string(),
                share_text(sum.active, sum.all),
                share_text(min, regions),
                share_text(max, regions),
                share_text(sum.srs, sum.all),
                share_text(sum.trs, sum.all),
                design.fingerprint(),
            ]);
            groups.push(clip.name.clone());
            ranges.push((percent(min, regions), percent(max, regions)));
            sums.push(sum);
        }
    }
    let mut findings = StudyFindings::new(Study::Temporal, &watched, table);
    let bars = |name: &str, colour, part: fn(&RegionCounts) -> u64, ranges| BarSeries {
        name: name.to_owned(),
        colour,
        values: sums.iter().map(|sum| percent(part(sum), sum.all)).collect(),
        ranges,
    };
    let series = vec![
        bars("active, line min to max", ACTIVE, |sum| sum.active, ranges),
        bars("SRS (relevant)", RELEVANT, |sum| sum.srs, Vec::new()),
        bars("TRS (changed)", CHANGED, |sum| sum.trs, Vec::new()),
    ];
    let chart = Chart {
        file_stem: "temporal".to_owned(),
        title: "Regions over whole clips".to_owned(),
        x_title: "clip".to_owned(),
        y_title: "share of regions [%]".to_owned(),
        caption: String::new(),
        shape: ChartData::Bars { groups, series },
    };
    findings.add_chart(chart, &watched);
    Ok(findings)
}
