// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a study makes of what was seen: a table and charts, with notes on where they come from.

use foveate_pictures::chart::Chart;

use crate::study::Study;
use crate::table::Table;
use crate::watch::Watched;

/// What a study makes of what was seen.
pub(crate) struct Findings {
    pub(crate) table: Table,
    /// Fewer rows and columns, to be printed where the table is too large.
    pub(crate) shown: Option<Table>,
    /// Tables beside it, with what follows the name of the study in the names of their files.
    pub(crate) more: Vec<(&'static str, Table)>,
    pub(crate) charts: Vec<Chart>,
    pub(crate) notes: Vec<String>,
    pub(crate) problems: Vec<String>,
}

impl Findings {
    /// Notes on the clips; charts are captioned with the first of them.
    pub(crate) fn new<T, G>(study: Study, watched: &[Watched<T, G>], table: Table) -> Self {
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
        Self { table, shown: None, more: Vec::new(), charts: Vec::new(), notes, problems }
    }

    /// Adds a chart with its caption: the program, the first design, the inputs.
    pub(crate) fn chart<T, G>(&mut self, mut chart: Chart, watched: &[Watched<T, G>]) {
        // The first note, which every study has.
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
