// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page of an exploration. It needs no script to be read, and loads nothing.

mod card;
mod colour;
mod scatter;
mod setting;
mod summary;
mod table;
mod threshold;

#[cfg(test)]
mod browser;
#[cfg(test)]
pub(crate) mod sample;
#[cfg(test)]
mod tests;

use askama::Template;
use foveate_pictures::page::{COLOURS, Notice, Page, PageError, Plot, Row, Table, Target, number};

use crate::{DesignRow, Exploration, ExploreError, Refused};
use card::Card;
use colour::Grouping;
use setting::Settings;

/// The most points that a page shows; with more it would be too large to open.
const POINTS: usize = 2000;
/// The most refused combinations that a page shows.
const REFUSED: usize = 500;
/// The targets of the links of a mark.
const TARGETS: [Target; 2] =
    [Target { prefix: "p", name: "its row" }, Target { prefix: "c", name: "its configuration" }];
/// The text at the end of the page.
const FOOTER: &str = "Everything here is also in the files beside this page: <code>points.csv</code>, \
    <code>points.parquet</code>, <code>pareto.csv</code>, <code>clips.csv</code>, \
    <code>exploration.json</code> and a configuration of every point in \
    <code>designs</code>.";

/// The section about the exploration, below the figures of the heading.
#[derive(Template)]
#[template(path = "about.html")]
struct About<'a> {
    clips: &'a [crate::ClipRow],
    clip_names: String,
    camera: String,
    ideal: &'a str,
    findings: Vec<String>,
    refused: &'a [Refused],
}

/// The other sections.
#[derive(Template)]
#[template(path = "main.html")]
struct Main<'a> {
    groupings: Vec<Grouping>,
    plots: Vec<Plot>,
    areas: bool,
    front: Table<'a>,
    points: Table<'a>,
    cards: Vec<Card>,
    /// The number of points that are not shown.
    hidden: usize,
    refused: &'a [Refused],
    /// The number of refused combinations that are not shown.
    hidden_refused: usize,
}

/// The script that colours points by another axis.
#[derive(Template)]
#[template(path = "colours.js", escape = "none")]
struct Colours {
    /// The number of colours that can be told apart.
    colours: usize,
}

/// Renders the page.
pub(crate) fn page(exploration: &Exploration) -> Result<String, ExploreError> {
    let settings = Settings::new(exploration);
    let rows = shown(&exploration.rows);
    let areas = exploration.rows.iter().any(|row| row.silicon.is_some());
    let groupings = colour::groupings(&settings, &rows);
    let titles: Vec<String> = rows.iter().map(|row| card::title(row, &settings)).collect();
    let mut plots = scatter::plots(exploration, &rows, &groupings, &titles);
    plots.extend(threshold::plots(&settings, &rows, &titles));
    let columns = table::columns(&settings, areas);
    let lines: Vec<Row> = rows.iter().map(|row| table::line(row, &settings, areas)).collect();
    let table = |prefix, tall, rows| Table {
        prefix,
        number: "number of the point",
        link: "all of it, with its configuration",
        tall,
        marks_best: tall,
        columns: &columns,
        rows,
    };
    let refused = exploration.refused.get(..REFUSED).unwrap_or(&exploration.refused);
    let about = About {
        clips: &exploration.clips,
        clip_names: summary::clips(exploration),
        camera: setting::camera(&exploration.ideal),
        ideal: exploration.ideal.trim_end(),
        findings: summary::findings(&exploration.rows, &settings),
        refused,
    };
    let main = Main {
        groupings,
        plots,
        areas,
        front: table("f", false, lines.iter().filter(|line| line.best).collect()),
        points: table("p", true, lines.iter().collect()),
        cards: rows.iter().map(|row| Card::new(row, &settings)).collect(),
        hidden: exploration.rows.len() - rows.len(),
        refused,
        hidden_refused: exploration.refused.len() - refused.len(),
    };
    let title = summary::title(exploration);
    let failed =
        |error: askama::Error| PageError { page: title.clone(), problem: error.to_string() };
    let page = Page {
        kind: "Exploration",
        program: &exploration.program,
        title: &title,
        notices: &[Notice { title: "Not complete", lines: &exploration.problems }],
        facts: &summary::facts(exploration),
        about: &about.render().map_err(failed)?,
        main: &main.render().map_err(failed)?,
        footer: FOOTER,
        targets: &TARGETS,
        script: &Colours { colours: COLOURS }.render().map_err(failed)?,
    };
    Ok(page.render()?)
}

/// Returns all points that a page shows. If there are too many, these are the points of the fronts
/// and an even sample of the others.
fn shown(rows: &[DesignRow]) -> Vec<&DesignRow> {
    let front = |row: &DesignRow| row.front.all || row.front.speed || row.front.area;
    let fronts = rows.iter().filter(|row| front(row)).count();
    let others = rows.len() - fronts;
    let every = others.div_ceil(POINTS.saturating_sub(fronts).max(1)).max(1);
    let mut passed = 0;
    let chosen = rows.iter().filter(|row| {
        passed += usize::from(!front(row));
        front(row) || passed % every == 0
    });
    chosen.take(POINTS).collect()
}
