// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page of an exploration. It needs no script to be read, and loads nothing.

mod card;
mod scatter;
mod setting;
mod table;
mod threshold;

#[cfg(test)]
mod browser;
#[cfg(test)]
pub(crate) mod sample;
#[cfg(test)]
mod tests;

use askama::Template;
use foveate_output::number_text;
use foveate_output::page::{
    COLOUR_COUNT, LinkTarget, PageError, PageNotice, PagePlot, ResultPage, SortableTable,
};

use crate::{DesignFront, DesignRow, Exploration, ExploreError};
use card::PointCard;
use scatter::PointGrouping;
use setting::PointSettings;

/// The most points that a page shows; with more it would be too large to open.
const MAX_POINTS_SHOWN: usize = 2000;
/// The targets of the links of a mark.
const TARGETS: [LinkTarget; 2] = [
    LinkTarget { prefix: "p", name: "its row" },
    LinkTarget { prefix: "c", name: "its configuration" },
];
/// The text at the end of the page.
const FOOTER: &str = "Everything here is also in the files beside this page: <code>points.csv</code>, \
    <code>points.parquet</code>, <code>clips.csv</code>, \
    <code>exploration.json</code> and a configuration of every point in \
    <code>designs</code>.";

/// The section about the exploration, below the figures of the heading.
#[derive(Template)]
#[template(path = "about.html")]
struct AboutSection<'a> {
    clips: &'a [crate::ClipRow],
    clip_names: String,
    camera: String,
    ideal: &'a str,
    findings: Vec<String>,
}

#[derive(Template)]
#[template(path = "main.html")]
struct MainSections<'a> {
    groupings: Vec<PointGrouping>,
    plots: Vec<PagePlot>,
    has_areas: bool,
    fronts: Vec<DesignFront<'a>>,
    settings: &'a PointSettings,
    points: SortableTable,
    cards: Vec<PointCard>,
    /// The number of points that are not shown.
    hidden: usize,
}

/// The script that colours points by another axis.
#[derive(Template)]
#[template(path = "colours.js", escape = "none")]
struct ColourScript {
    /// The number of colours that can be told apart.
    colours: usize,
}

pub(crate) fn render_page(exploration: &Exploration) -> Result<String, ExploreError> {
    let settings = PointSettings::new(exploration);
    let rows = points_shown(&exploration.rows);
    let has_synthesis = exploration.rows.iter().any(|row| row.silicon.is_some());
    let groupings = scatter::groupings(&settings, &rows);
    let titles: Vec<String> = rows.iter().map(|row| card::mark_title(row, &settings)).collect();
    let mut plots = scatter::plots(exploration, &rows, &groupings, &titles);
    plots.extend(threshold::plots(&settings, &rows, &titles));
    let about = AboutSection {
        clips: &exploration.clips,
        clip_names: table::clips(exploration),
        camera: setting::camera_line(&exploration.ideal),
        ideal: exploration.ideal.trim_end(),
        findings: exploration.findings(),
    };
    let main = MainSections {
        groupings,
        plots,
        has_areas: has_synthesis || exploration.awaited_areas > 0,
        fronts: exploration.fronts(),
        settings: &settings,
        points: table::point_table(&settings, &rows, &titles),
        cards: rows.iter().map(|row| PointCard::new(row, &settings)).collect(),
        hidden: exploration.rows.len() - rows.len(),
    };
    let title = table::title(exploration);
    let failed =
        |error: askama::Error| PageError { page: title.clone(), problem: error.to_string() };
    let awaited = (exploration.awaited_areas > 0).then(|| {
        let (awaited, all) = (exploration.awaited_areas, exploration.rows.len());
        format!(
            "The areas of {awaited} of {all} designs are not known yet: the front and the plot of area, and those of \
             frames per second, are about the others. The page is written again as areas arrive; after an interrupt \
             the same command goes on."
        )
    });
    let page = ResultPage {
        kind: "Exploration",
        program: &exploration.program,
        title: &title,
        notices: &[
            PageNotice { title: "Not complete", lines: &exploration.problems },
            PageNotice { title: "Not finished", lines: awaited.as_slice() },
        ],
        facts: &table::facts(exploration),
        about: &about.render().map_err(failed)?,
        main: &main.render().map_err(failed)?,
        footer: FOOTER,
        targets: &TARGETS,
        script: &ColourScript { colours: COLOUR_COUNT }.render().map_err(failed)?,
    };
    Ok(page.render()?)
}

/// Returns all points that a page shows. If there are too many, these are the points of the fronts
/// and an even sample of the others.
fn points_shown(rows: &[DesignRow]) -> Vec<&DesignRow> {
    let front = |row: &DesignRow| row.front.any();
    let fronts = rows.iter().filter(|row| front(row)).count();
    let others = rows.len() - fronts;
    let every = others.div_ceil(MAX_POINTS_SHOWN.saturating_sub(fronts).max(1)).max(1);
    let mut passed = 0;
    let chosen = rows.iter().filter(|row| {
        passed += usize::from(!front(row));
        front(row) || passed % every == 0
    });
    chosen.take(MAX_POINTS_SHOWN).collect()
}
