// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a request to a folder.

use std::path::{Path, PathBuf};

use foveate_design::Config;
use foveate_footage::{InputOptions, subjects};
use foveate_simulator::BatchHooks;
use foveate_staging::{Kind, StagedFolder};
use serde::Serialize;

use crate::StudyError;
use crate::findings::Findings;
use crate::study::{Study, activity, histogram, redundancy, sensor, sweep, temporal};
use crate::table::Table;
use crate::watch::Watcher;

/// What is studied.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// Which study.
    pub study: Study,
    /// Clips and sets, one each; image files together are one clip.
    pub inputs: &'a [PathBuf],
    /// How they are read.
    pub input: &'a InputOptions,
    /// The design, which a study may vary.
    pub config: &'a Config,
    /// For [`Study::Sensor`]: what the sensor sent, as CSV (`.gz` or not) with columns `t_us,x,y`.
    pub sensor_events: Option<&'a Path>,
    /// For [`Study::Sensor`]: the time of the first frame on the clock of the events.
    pub sensor_start_us: u64,
}

/// What a study found, and the files that it left.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Report {
    /// Name of the study.
    pub study: &'static str,
    /// Names of the files.
    pub files: Vec<String>,
    /// Columns of the table.
    pub columns: Vec<&'static str>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
    /// Clips that ended before their end, and why.
    pub problems: Vec<String>,
}

impl Report {
    /// The table as Markdown.
    #[must_use]
    pub fn markdown(&self) -> String {
        Table { columns: self.columns.clone(), rows: self.rows.clone() }.markdown()
    }
}

/// Runs a study and writes `output`, which appears at the end.
///
/// # Errors
/// When an input cannot be read or does not fit the study, the folder cannot be written, or `hooks`
/// cancels; nothing is written then.
pub fn analyze(
    request: &Request<'_>,
    output: &Path,
    overwrite: bool,
    hooks: &dyn BatchHooks,
) -> Result<Report, StudyError> {
    let study = request.study;
    let staging = StagedFolder::new(output, STUDY, overwrite)?;
    let subjects = subjects(request.inputs, request.input)?;
    let watcher =
        Watcher { subjects: &subjects, config: request.config, input: request.input, hooks };
    let findings = run(&watcher, request)?;
    let mut files = vec![format!("{}.csv", study.name())];
    staging.write(&files[0], findings.table.csv(&findings.notes).as_bytes())?;
    for chart in &findings.charts {
        for (extension, contents) in
            [("svg", chart.svg(&findings.notes)?.into_bytes()), ("png", chart.png()?)]
        {
            let name = format!("{}.{extension}", chart.file);
            staging.write(&name, &contents)?;
            files.push(name);
        }
    }
    staging.commit()?;
    let Table { columns, rows } = findings.table;
    Ok(Report { study: study.name(), files, columns, rows, problems: findings.problems })
}

fn run(watcher: &Watcher<'_>, request: &Request<'_>) -> Result<Findings, StudyError> {
    match request.study {
        Study::Activity => activity::run(watcher),
        Study::Temporal => temporal::run(watcher),
        Study::Redundancy => redundancy::run(watcher),
        Study::MadHistogram => histogram::run(watcher),
        Study::Size => sweep::size(watcher),
        Study::Threshold => sweep::threshold(watcher),
        Study::Sensor => sensor::run(watcher, request.sensor_events, request.sensor_start_us),
    }
}

const STUDY: Kind = Kind { what: "a study (its CSV)", is: is_study, listed: true };

fn is_study(folder: &Path) -> bool {
    Study::ALL.iter().any(|study| {
        std::fs::read_to_string(folder.join(format!("{}.csv", study.name())))
            .is_ok_and(|text| text.starts_with("# foveate "))
    })
}
