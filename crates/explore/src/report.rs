// SPDX-License-Identifier: MIT OR Apache-2.0
//! One page that shows an exploration: no script is needed to read it and nothing is loaded.

mod axis;
mod card;
mod colour;
mod number;
mod plot;
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
use foveate_palette::{DARK, LIGHT};

use crate::{Exploration, ExploreError, Refused, Row};
use card::Card;
use colour::Grouping;
use plot::Plot;
use setting::Settings;
use summary::Fact;
use table::{Column, Line};

/// Points that a page shows; with more it would be too large to open.
const POINTS: usize = 2000;
/// Refused combinations that it shows.
const REFUSED: usize = 500;

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    program: &'a str,
    /// Colours as variables, on a light ground and on a dark one.
    light: String,
    dark: String,
    /// How many colours can be told apart.
    colours: usize,
    title: String,
    problems: &'a [String],
    facts: Vec<Fact>,
    clips: &'a [crate::ClipRow],
    clip_names: String,
    camera: String,
    ideal: &'a str,
    findings: Vec<String>,
    groupings: Vec<Grouping>,
    plots: Vec<Plot>,
    areas: bool,
    columns: Vec<Column>,
    pareto: Vec<&'a Line>,
    lines: &'a [Line],
    cards: Vec<Card>,
    /// Points that are not shown.
    hidden: usize,
    refused: &'a [Refused],
    /// Refused combinations that are not shown.
    hidden_refused: usize,
}

/// The page.
pub(crate) fn page(exploration: &Exploration) -> Result<String, ExploreError> {
    let settings = Settings::new(exploration);
    let rows = shown(&exploration.rows);
    let areas = exploration.rows.iter().any(|row| row.silicon.is_some());
    let groupings = colour::groupings(&settings, &rows);
    let titles: Vec<String> = rows.iter().map(|row| card::title(row, &settings)).collect();
    let mut plots = scatter::plots(exploration, &rows, &groupings, &titles);
    plots.extend(threshold::plots(&settings, &rows, &titles));
    let lines: Vec<Line> = rows.iter().map(|row| table::line(row, &settings, areas)).collect();
    let refused = exploration.refused.get(..REFUSED).unwrap_or(&exploration.refused);
    let page = Page {
        program: &exploration.program,
        light: colour::variables(&LIGHT),
        dark: colour::variables(&DARK),
        colours: colour::COLOURS,
        title: summary::title(exploration),
        problems: &exploration.problems,
        facts: summary::facts(exploration),
        clips: &exploration.clips,
        clip_names: summary::clips(exploration),
        camera: setting::camera(&exploration.ideal),
        ideal: exploration.ideal.trim_end(),
        findings: summary::findings(&exploration.rows, &settings),
        groupings,
        plots,
        areas,
        columns: table::columns(&settings, areas),
        pareto: lines.iter().filter(|line| line.front).collect(),
        lines: &lines,
        cards: rows.iter().map(|row| Card::new(row, &settings)).collect(),
        hidden: exploration.rows.len() - rows.len(),
        refused,
        hidden_refused: exploration.refused.len() - refused.len(),
    };
    page.render().map_err(|error| ExploreError::Page { problem: error.to_string() })
}

/// All rows; of too many those of the fronts and an even sample of the others.
fn shown(rows: &[Row]) -> Vec<&Row> {
    let front = |row: &Row| row.front.all || row.front.speed || row.front.area;
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
