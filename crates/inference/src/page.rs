// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page of a run: its setup, its savings, charts, tables, and the command that repeats it. The
//! page needs no script to be read, and loads nothing.

mod again;
mod figures;
mod plots;
mod rows;
mod shots;
#[cfg(test)]
mod tests;
mod words;

use crate::Summary;
use crate::charts::charts;
use crate::frame::{Frame, counted};
use crate::sight::Shots;
use askama::Template;
use foveate_design::Design;
use foveate_pictures::page::{Notice, Page, PageError, Plot, Table, Target};
use rows::Rows;

/// The most frames that a page shows; with more it would be too large to open.
const FRAMES: usize = 400;
/// The target of the links of marks: the row of a mark.
const TARGETS: [Target; 1] = [Target { prefix: "p", name: "its row" }];

/// The section about the run and its findings.
#[derive(Template)]
#[template(path = "about.html")]
struct About {
    run: String,
    findings: Vec<String>,
    tuned: bool,
    counted: bool,
    several: bool,
    shots: bool,
}

/// The other sections.
#[derive(Template)]
#[template(path = "main.html")]
struct Main<'a> {
    /// The frames with detections, if the network finds objects.
    shots: Option<shots::Pictures>,
    plots: Vec<Plot>,
    /// The table of clips, if there are several.
    clips: Option<Table<'a>>,
    layers: Table<'a>,
    tried: Option<Table<'a>>,
    /// The table of counted frames, if there are any.
    frames: Option<Table<'a>>,
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
struct Files<'a> {
    tuned: bool,
    detected: bool,
    outputs: &'a [crate::Recorded],
}

/// Renders the page.
pub(crate) fn page(
    summary: &Summary,
    frames: &[Frame],
    shots: Option<&Shots>,
    design: &Design,
    command: &[String],
) -> Result<String, PageError> {
    let frames = counted(frames);
    let every = frames.len().div_ceil(FRAMES).max(1);
    let shown = shown(&frames, every);
    let is_counted = !frames.is_empty();
    let (layers, tried, rows) =
        (rows::layers(summary), rows::tried(summary), rows::frames(&shown, summary));
    let clips = rows::clips(summary);
    let titles = [&layers, &tried, &rows].into_iter().flat_map(Rows::titles).collect();
    let charts = if is_counted { charts(summary, &shown) } else { Vec::new() };
    let note = if every > 1 { words::sampled(every) } else { String::new() };
    let title = words::title(summary);
    let failed =
        |error: askama::Error| PageError { page: title.clone(), problem: error.to_string() };
    let about = About {
        run: words::run(summary, design),
        findings: words::findings(summary),
        tuned: summary.tuning.is_some(),
        counted: is_counted,
        several: summary.clips.len() > 1,
        shots: shots.is_some_and(|shots| !shots.kept().is_empty()),
    };
    let main = Main {
        shots: shots.map(shots::pictures).transpose()?.flatten(),
        plots: charts.iter().map(|drawn| plots::plot(drawn, &titles, &note)).collect(),
        clips: (summary.clips.len() > 1).then(|| clips.table("number of the clip")),
        layers: layers.table("number of the layer"),
        tried: summary.tuning.is_some().then(|| tried.table("number of the run")),
        frames: is_counted.then(|| rows.table("number of the frame")),
        every,
        command: again::line(command),
        camera: words::camera(design),
        toml: design.config().to_toml(),
        fingerprint: design.fingerprint(),
        accelerated: summary.accelerator.is_some(),
        compared: summary.error.is_some(),
        sighted: summary.sight.is_some(),
    };
    let files = Files {
        tuned: summary.tuning.is_some(),
        detected: summary.sight.as_ref().is_some_and(|sight| sight.detections.is_some()),
        outputs: &summary.outputs,
    };
    let page = Page {
        kind: "Inference",
        program: &format!("foveate {}", summary.foveate_version),
        title: &title,
        notices: &[
            Notice { title: "Not complete", lines: &words::problems(summary) },
            Notice { title: "Note", lines: &summary.warnings },
        ],
        facts: &figures::facts(summary),
        about: &about.render().map_err(failed)?,
        main: &main.render().map_err(failed)?,
        footer: &files.render().map_err(failed)?,
        targets: &TARGETS,
        script: "",
    };
    page.render()
}

/// Returns, of every `every` frames in a row, the frame that needs the most MACs, so that no peak
/// is lost.
fn shown<'a>(frames: &[&'a Frame], every: usize) -> Vec<&'a Frame> {
    let by_macs = |one: &&&Frame, other: &&&Frame| {
        // Of equal frames the first one is taken.
        one.macs.needed.total_cmp(&other.macs.needed).then(other.place.cmp(&one.place))
    };
    let most = |frames: &[&'a Frame]| frames.iter().max_by(by_macs).copied();
    frames.chunks(every).filter_map(most).collect()
}
