// SPDX-License-Identifier: MIT OR Apache-2.0
//! The findings of a study: a table and charts, with notes about their origin.

use foveate_output::chart::Chart;
use foveate_output::report::ReportTable;

use crate::studies::runner::ClipResult;
use crate::studies::study::Study;

pub(crate) struct StudyFindings {
    pub(crate) table: ReportTable,
    /// A smaller table, which is printed if the table is too large.
    pub(crate) printed: Option<ReportTable>,
    /// Further tables, each with the suffix that follows the study's name in its file name.
    pub(crate) further_tables: Vec<(&'static str, ReportTable)>,
    pub(crate) charts: Vec<Chart>,
    pub(crate) notes: Vec<String>,
    pub(crate) problems: Vec<String>,
}

impl StudyFindings {
    /// Creates findings with notes on the clips.
    pub(crate) fn new<T, G>(
        study: Study,
        watched: &[ClipResult<T, G>],
        table: ReportTable,
    ) -> Self {
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
        Self {
            table,
            printed: None,
            further_tables: Vec::new(),
            charts: Vec::new(),
            notes,
            problems,
        }
    }

    /// Adds a chart, with a caption that names the program, the first designs and the inputs.
    pub(crate) fn add_chart<T, G>(&mut self, mut chart: Chart, watched: &[ClipResult<T, G>]) {
        // The first note names the program; every study has it.
        let program = self.notes[0].clone();
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
