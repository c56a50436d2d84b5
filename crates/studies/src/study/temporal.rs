// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shares over whole clips, with a row per clip.

use std::slice::from_ref;

use foveate_pictures::chart::{Bars, Chart, Shape};
use foveate_pictures::palette::{ACTIVE, CHANGED, RELEVANT};

use super::{Study, clips_only};
use crate::StudyError;
use crate::findings::Findings;
use crate::number::{percent, share};
use crate::table::Table;
use crate::tally::{RegionTally, Regions};
use crate::watch::Watcher;

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

pub(crate) fn run(watcher: &Watcher<'_>) -> Result<Findings, StudyError> {
    let watched = watcher
        .watch(from_ref(watcher.config), |tally: &mut RegionTally, _, seen| tally.add(seen))?;
    clips_only(Study::Temporal, &watched)?;
    let mut table = Table::new(&COLUMNS);
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
                share(sum.active, sum.all),
                share(min, regions),
                share(max, regions),
                share(sum.srs, sum.all),
                share(sum.trs, sum.all),
                design.fingerprint(),
            ]);
            groups.push(clip.name.clone());
            ranges.push((percent(min, regions), percent(max, regions)));
            sums.push(sum);
        }
    }
    let mut findings = Findings::new(Study::Temporal, &watched, table);
    let bars = |name: &str, colour, part: fn(&Regions) -> u64, ranges| Bars {
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
        file: "temporal".to_owned(),
        title: "Regions over whole clips".to_owned(),
        x: "clip".to_owned(),
        y: "share of regions [%]".to_owned(),
        caption: String::new(),
        shape: Shape::Bars { groups, series },
    };
    findings.chart(chart, &watched);
    Ok(findings)
}
