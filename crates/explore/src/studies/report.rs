// SPDX-License-Identifier: MIT OR Apache-2.0
//! The run of a study: it takes a request and writes a folder.

use foveate_output::report::ReportTable;
use std::path::{Path, PathBuf};

use foveate_design::DesignConfig;
use foveate_media::{InputOptions, RunClips, RunHooks, RunMonitor};
use foveate_tools::{FolderKind, StagedFolder};
use serde::Serialize;

use crate::studies::StudyError;
use crate::studies::findings::StudyFindings;
use crate::studies::runner::StudyRunner;
use crate::studies::study::{
    Study, activity, histogram, recall, redundancy, sensor, sweep, temporal,
};

/// The request of a study.
#[derive(Clone, Debug)]
pub struct StudyRequest<'a> {
    /// The study.
    pub study: Study,
    /// The clips and data sets. Image files together are one clip; every other input is its own.
    pub inputs: &'a [PathBuf],
    /// The options for reading the inputs.
    pub input: &'a InputOptions,
    /// The design, which a study may vary.
    pub config: &'a DesignConfig,
    /// The events of a real sensor for [`Study::Sensor`], as CSV (`.gz` or not) with the columns
    /// `t_us,x,y`.
    pub sensor_events: Option<&'a Path>,
    /// The time of the first frame on the clock of the events in microseconds, for
    /// [`Study::Sensor`].
    pub sensor_start_us: u64,
    /// The ground-truth boxes for [`Study::Recall`]: one file or folder for all inputs, or one for
    /// each.
    pub boxes: &'a [PathBuf],
}

/// The result of a study, and the files that it wrote.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StudyReport {
    /// The name of the study.
    pub study: &'static str,
    /// The range of the luma of clips that are video: `coded` or `full`.
    pub luma: &'static str,
    /// The names of the files.
    pub files: Vec<String>,
    /// The columns of the table.
    pub columns: Vec<String>,
    /// The rows of the table.
    pub rows: Vec<Vec<String>>,
    /// The clips that ended early, with the reasons.
    pub problems: Vec<String>,
    /// A smaller table, which is printed if the table is too large.
    #[serde(skip)]
    printed: Option<ReportTable>,
}

impl StudyReport {
    /// Returns the table as Markdown, or the smaller table if the table is too large.
    #[must_use]
    pub fn markdown(&self) -> String {
        let (columns, rows) = (self.columns.clone(), self.rows.clone());
        let whole = || ReportTable { rows, ..ReportTable::of_words(columns) };
        self.printed.clone().unwrap_or_else(whole).markdown()
    }
}

/// Runs a study and writes `output`, which appears at the end.
///
/// # Errors
/// Fails if an input cannot be read or does not fit the study, the folder cannot be written, or
/// `hooks` cancels; nothing is written then.
pub fn analyze(
    request: &StudyRequest<'_>,
    output: &Path,
    overwrite: bool,
    hooks: &dyn RunHooks,
) -> Result<StudyReport, StudyError> {
    let study = request.study;
    let staging = StagedFolder::new(output, STUDY_FOLDER, overwrite)?;
    // Only this study counts objects.
    let boxes = if study == Study::Recall { request.boxes } else { &[] };
    let camera = &request.config.camera;
    let clips = RunClips::new(request.inputs, boxes, camera, request.input)?;
    let monitor = RunMonitor::of_clips(hooks, clips.clips().len());
    let watcher = StudyRunner { clips: &clips, config: request.config, monitor };
    let findings = run_study(&watcher, request)?;
    let mut files = vec![format!("{}.csv", study.name())];
    staging.write(&files[0], findings.table.csv(&findings.notes).as_bytes())?;
    for (name, table) in &findings.further_tables {
        let name = format!("{}-{name}.csv", study.name());
        staging.write(&name, table.csv(&findings.notes).as_bytes())?;
        files.push(name);
    }
    for chart in &findings.charts {
        for (extension, contents) in
            [("svg", chart.to_svg(&findings.notes)?.into_bytes()), ("png", chart.to_png()?)]
        {
            let name = format!("{}.{extension}", chart.file_stem);
            staging.write(&name, &contents)?;
            files.push(name);
        }
    }
    staging.commit()?;
    let StudyFindings { table, printed, problems, .. } = findings;
    Ok(StudyReport {
        study: study.name(),
        luma: request.input.luma.name(),
        files,
        columns: table.header,
        rows: table.rows,
        problems,
        printed,
    })
}

fn run_study(
    watcher: &StudyRunner<'_>,
    request: &StudyRequest<'_>,
) -> Result<StudyFindings, StudyError> {
    match request.study {
        Study::Activity => activity::run(watcher),
        Study::Temporal => temporal::run(watcher),
        Study::Redundancy => redundancy::run(watcher),
        Study::MadHistogram => histogram::run(watcher),
        Study::Size => sweep::run_size(watcher),
        Study::Threshold => sweep::run_threshold(watcher),
        Study::Sensor => sensor::run(watcher, request.sensor_events, request.sensor_start_us),
        Study::Recall => recall::run(watcher),
    }
}

/// The kind of folder that a study writes, and the only kind that it replaces.
pub const STUDY_FOLDER: FolderKind =
    FolderKind { description: "a study (its CSV)", matches: is_study };

fn is_study(folder: &Path) -> bool {
    Study::ALL.iter().any(|study| {
        std::fs::read_to_string(folder.join(format!("{}.csv", study.name())))
            .is_ok_and(|text| text.starts_with("# foveate "))
    })
}
