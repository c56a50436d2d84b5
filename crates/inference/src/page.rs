// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page of a run: its setup, its savings, charts, tables, and the command that repeats it. The
//! page needs no script to be read, and loads nothing.

mod command_line;
mod figures;
mod rows;
mod sentences;
#[cfg(test)]
mod tests;

use crate::InferenceSummary;
use crate::charts::charts;
use crate::frame::{FrameFigures, counted_frames};
use crate::whole_frames::KeptScreens;
use askama::Template;
use foveate_design::Design;
use foveate_output::page::{
    LinkTarget, PageError, PageNotice, PagePlot, ResultPage, SortableTable,
};

/// The largest number of frames that a page shows. A page with more would be too large to open.
const MAX_FRAMES: usize = 400;
/// The target of the links of marks: the row of a mark.
const TARGETS: [LinkTarget; 1] = [LinkTarget { prefix: "p", name: "its row" }];

/// The section about the run and its findings.
#[derive(Template)]
#[template(path = "about.html")]
struct AboutSection {
    run: String,
    findings: Vec<String>,
    tuned: bool,
    counted: bool,
    several: bool,
    shots: bool,
}

#[derive(Template)]
#[template(path = "main.html")]
struct MainSections {
    /// The frames with detections, if the network finds objects.
    shots: Option<figures::FramePictures>,
    plots: Vec<PagePlot>,
    /// The table of clips, if there are several.
    clips: Option<SortableTable>,
    layers: SortableTable,
    tried: Option<SortableTable>,
    /// The table of counted frames, if there are any.
    frames: Option<SortableTable>,
    /// The number of counted frames of which one is shown.
    every: usize,
    command: String,
    camera: String,
    toml: String,
    fingerprint: String,
    accelerated: bool,
    compared: bool,
    sighted: bool,
}

/// The footer, with the files of the run.
#[derive(Template)]
#[template(path = "files.html")]
struct FilesFooter<'a> {
    tuned: bool,
    detected: bool,
    outputs: &'a [crate::RecordedOutput],
}

pub(crate) fn render_page(
    summary: &InferenceSummary,
    frames: &[FrameFigures],
    shots: Option<&KeptScreens>,
    design: &Design,
    command: &[String],
) -> Result<String, PageError> {
    let frames = counted_frames(frames);
    let every = frames.len().div_ceil(MAX_FRAMES).max(1);
    let shown = most_expensive_frames(&frames, every);
    let is_counted = !frames.is_empty();
    let (layers, tried, rows) =
        (rows::layers(summary), rows::trials(summary), rows::frames(&shown, summary));
    let all_rows = [&layers, &tried, &rows].into_iter().flat_map(|table| &table.rows);
    let titles = all_rows.map(|row| (&row.id[..], &row.mark_title[..])).collect();
    let charts = if is_counted { charts(summary, &shown) } else { Vec::new() };
    let note = if every > 1 { sentences::sampling_note(every) } else { String::new() };
    let plots = charts.iter().map(|drawn| figures::plot(drawn, &titles, &note)).collect();
    let title = sentences::title(summary);
    let failed =
        |error: askama::Error| PageError { page: title.clone(), problem: error.to_string() };
    let about = AboutSection {
        run: sentences::run_sentences(summary, design),
        findings: sentences::findings(summary),
        tuned: summary.tuning.is_some(),
        counted: is_counted,
        several: summary.clips.len() > 1,
        shots: shots.is_some_and(|shots| !shots.screens().is_empty()),
    };
    let main = MainSections {
        shots: shots.map(figures::frame_pictures).transpose()?.flatten(),
        plots,
        clips: (summary.clips.len() > 1).then(|| rows::clips(summary)),
        layers,
        tried: summary.tuning.is_some().then_some(tried),
        frames: is_counted.then_some(rows),
        every,
        command: command_line::shell_command(command),
        camera: sentences::camera_text(design),
        toml: design.config().to_toml(),
        fingerprint: design.fingerprint(),
        accelerated: summary.accelerator.is_some(),
        compared: summary.error.is_some(),
        sighted: summary.sight.is_some(),
    };
    let files = FilesFooter {
        tuned: summary.tuning.is_some(),
        detected: summary.sight.as_ref().is_some_and(|sight| sight.detections.is_some()),
        outputs: &summary.outputs,
    };
    let page = ResultPage {
        kind: "Inference",
        program: &format!("foveate {}", summary.foveate_version),
        title: &title,
        notices: &[
            PageNotice { title: "Not complete", lines: &sentences::problems(summary) },
            PageNotice { title: "Note", lines: &summary.warnings },
        ],
        facts: &figures::heading_facts(summary),
        about: &about.render().map_err(failed)?,
        main: &main.render().map_err(failed)?,
        footer: &files.render().map_err(failed)?,
        targets: &TARGETS,
        script: "",
    };
    page.render()
}

/// Returns one frame of each `every` consecutive frames: the frame that needs the most MACs, so
/// that no peak is lost.
fn most_expensive_frames<'a>(frames: &[&'a FrameFigures], every: usize) -> Vec<&'a FrameFigures> {
    let by_macs = |one: &&&FrameFigures, other: &&&FrameFigures| {
        // The first of equal frames is taken.
        one.macs
            .needed
            .total_cmp(&other.macs.needed)
            .then(other.index_in_run.cmp(&one.index_in_run))
    };
    let most = |frames: &[&'a FrameFigures]| frames.iter().max_by(by_macs).copied();
    frames.chunks(every).filter_map(most).collect()
}
