// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a request to a folder.

use std::path::{Path, PathBuf};

use foveate_design::Config;
use foveate_footage::{InputOptions, subjects};
use foveate_simulator::BatchHooks;
use foveate_staging::{Kind, StagedFolder};
use serde::Serialize;

use crate::StudyError;
use crate::chart::Chart;
use crate::study::Study;
use crate::table::Table;
use crate::watch::{Watched, Watcher};

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

/// What a study makes of what was seen.
pub(crate) struct Findings {
    pub(crate) table: Table,
    pub(crate) charts: Vec<Chart>,
    pub(crate) notes: Vec<String>,
    pub(crate) problems: Vec<String>,
}

impl Findings {
    /// Notes on the clips; charts are captioned with the first of them.
    pub(crate) fn new<T>(study: Study, watched: &[Watched<T>], table: Table) -> Self {
        let version = env!("CARGO_PKG_VERSION");
        let mut notes = vec![format!("foveate {version} analyze {}", study.name())];
        let mut problems = Vec::new();
        for clip in watched {
            let design = clip.points.first().map(|(design, _)| {
                let (width, height) = (design.width(), design.height());
                format!("design {}, {width}x{height} pixels, ", design.fingerprint())
            });
            notes.push(format!(
                "{}: {}{} frames, inputs {}",
                clip.name,
                design.unwrap_or_default(),
                clip.frames,
                clip.inputs.join(" ")
            ));
            problems.extend(clip.problem.as_ref().map(|why| format!("{}: {why}", clip.name)));
        }
        notes.extend(problems.iter().map(|problem| format!("NOT COMPLETE: {problem}")));
        Self { table, charts: Vec::new(), notes, problems }
    }

    /// Adds a chart with its caption: the program, the first design, the inputs.
    pub(crate) fn chart<T>(&mut self, mut chart: Chart, watched: &[Watched<T>]) {
        let program = self.notes.first().cloned().unwrap_or_default();
        let mut designs: Vec<String> = watched
            .iter()
            .filter_map(|clip| clip.points.first().map(|(design, _)| design.fingerprint()))
            .collect();
        designs.sort();
        designs.dedup();
        let names: Vec<&str> = watched.iter().map(|clip| clip.name.as_str()).collect();
        let first = |items: Vec<String>, most: usize| match items.len().saturating_sub(most) {
            0 => items.join(", "),
            more => format!("{} and {more} more", items[..most].join(", ")),
        };
        let names = first(names.into_iter().map(str::to_owned).collect(), 4);
        let incomplete = if self.problems.is_empty() { "" } else { " · NOT COMPLETE" };
        chart.caption =
            format!("{program} · design {} · inputs {names}{incomplete}", first(designs, 2));
        self.charts.push(chart);
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
    let findings = study.run(&watcher, request)?;
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

const STUDY: Kind = Kind { what: "a study (its CSV)", is: is_study, listed: true };

fn is_study(folder: &Path) -> bool {
    Study::ALL.iter().any(|study| {
        std::fs::read_to_string(folder.join(format!("{}.csv", study.name())))
            .is_ok_and(|text| text.starts_with("# foveate "))
    })
}
