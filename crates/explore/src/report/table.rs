// SPDX-License-Identifier: MIT OR Apache-2.0
//! An exploration in words and numbers: the columns of `points.csv` with headings for people
//! ([`columns_and_rows`]), and above them the setup and the findings in a few lines
//! ([`facts`]).

use super::setting::{PointSettings, axes_set};
use crate::link::LinkRate;
use crate::row::{count_to_f64, load_cells, point_cells, process_cells};
use crate::{DesignRow, Exploration};
use foveate_output::number_text::{MISSING, counted, grouped, percent, real_number};
use foveate_output::page::{HeadingFigure, SortableTable, TableCell, TableColumn, TableRow};
use foveate_output::tables::{NamedCells, TableCell as FileCell};
use std::collections::HashMap;

/// The figures, a line each: a column of `points.csv`, the heading, its unit, the form of the
/// number, and its meaning.
const FIGURES: &str = include_str!("../../templates/figures.txt");

/// The cells of a point by the columns of `points.csv`.
type PointFigures = HashMap<String, FileCell>;

struct FigureColumn {
    key: &'static str,
    /// The form of the number: `percent`, `millions`, or digits after the point. `decibels` of
    /// equal frames are not known, and `on_clip` adds the worst clip to the percentage.
    form: &'static str,
    heading: TableColumn,
}

impl FigureColumn {
    fn all() -> impl Iterator<Item = Self> {
        FIGURES.lines().map(|line| {
            let mut parts = line.split('|');
            let mut part = || parts.next().unwrap_or_default();
            let (key, name, unit, form, title) = (part(), part(), part(), part(), part());
            let (name, title) = (name.to_owned(), title.to_owned());
            Self { key, form, heading: TableColumn { name, unit, title, numbers: true } }
        })
    }

    fn value(&self, figures: &PointFigures) -> Option<f64> {
        match figures.get(self.key)? {
            FileCell::Count(count) => count.map(count_to_f64),
            FileCell::Real(value) => *value,
            FileCell::Text(_) | FileCell::Flag(_) => None,
        }
    }

    fn cell(&self, figures: &PointFigures) -> TableCell {
        let (value, form) = (self.value(figures), self.form);
        let Some(number) = value.filter(|_| form != "decibels") else {
            return if form == "decibels" { TableCell::psnr(value) } else { TableCell::missing() };
        };
        let text = match (form, figures.get("worst_clip")) {
            ("on_clip", Some(FileCell::Text(clip))) => {
                let name: String = clip.chars().take(12).collect();
                let more = if name == *clip { "" } else { "…" };
                format!("{} {name}{more}", percent(number))
            }
            ("percent" | "on_clip", _) => percent(number),
            ("millions", _) => real_number(number / 1e6, 3),
            (digits, _) => real_number(number, digits.parse().unwrap_or_default()),
        };
        TableCell::number(text, value)
    }
}

/// Returns the table of the points, with the texts of their marks. A figure that no point has is left out.
pub(crate) fn point_table(
    settings: &PointSettings,
    rows: &[&DesignRow],
    titles: &[String],
) -> SortableTable {
    let figures: Vec<PointFigures> = rows.iter().map(|row| figures_of(row)).collect();
    let is_shown = |column: &FigureColumn| {
        column.form == "decibels" || figures.iter().any(|one| column.value(one).is_some())
    };
    let shown: Vec<FigureColumn> = FigureColumn::all().filter(is_shown).collect();
    let axis = |name: &str, title: &str| TableColumn {
        name: name.to_owned(),
        unit: "",
        title: title.to_owned(),
        numbers: false,
    };
    let mut columns: Vec<TableColumn> = if settings.is_one_at_a_time {
        vec![axis("changed setting", "the one setting that differs from the start")]
    } else {
        settings.names.iter().zip(&settings.keys).map(|(name, key)| axis(name, key)).collect()
    };
    let row = |((row, figures), title): ((&&DesignRow, &PointFigures), &String)| {
        let mut cells = setting_cells(settings, row);
        cells.extend(shown.iter().map(|column| column.cell(figures)));
        let (id, number) = (row.number.to_string(), row.number as u64);
        TableRow { id, number, best: row.front.any(), cells, mark_title: title.clone() }
    };
    let rows = rows.iter().zip(&figures).zip(titles).map(row).collect();
    columns.extend(shown.into_iter().map(|column| column.heading));
    SortableTable {
        prefix: "p",
        number: "number of the point",
        link: "all figures of the point, with its configuration",
        tall: true,
        marks_best: true,
        columns,
        rows,
    }
}

fn setting_cells(settings: &PointSettings, row: &DesignRow) -> Vec<TableCell> {
    let setting = |text: String, is_set: bool| {
        let class = if is_set { "" } else { "start" };
        TableCell { class, ..TableCell::text(text) }
    };
    let is_set = |axis: usize| row.settings.get(axis).is_some_and(|text| !text.is_empty());
    if settings.is_one_at_a_time {
        vec![setting(settings.settings_text(row, None), axes_set(row).next().is_some())]
    } else {
        let axes = 0..settings.names.len();
        axes.map(|axis| setting(settings.value(row, axis), is_set(axis))).collect()
    }
}

fn figures_of(row: &DesignRow) -> PointFigures {
    let all: [NamedCells; 3] =
        [point_cells(row, &[]), process_cells(row), load_cells(row.load.as_ref())];
    all.into_iter().flatten().collect()
}

/// Returns the title of the page.
pub(crate) fn title(exploration: &Exploration) -> String {
    let points = counted(exploration.rows.len(), "design");
    match exploration.clips.as_slice() {
        [clip] => format!("{points} over {}", clip.name),
        clips => format!("{points} over {}", counted(clips.len(), "clip")),
    }
}

/// Returns the names of the first few clips.
pub(crate) fn clips(exploration: &Exploration) -> String {
    const NAMED: usize = 4;
    let clips = &exploration.clips;
    let names: Vec<&str> = clips.iter().take(NAMED).map(|clip| clip.name.as_str()).collect();
    let more = if clips.len() > NAMED { " and more" } else { "" };
    names.join(", ") + more
}

pub(crate) fn facts(exploration: &Exploration) -> Vec<HeadingFigure> {
    let Exploration { rows, clips, axes, .. } = exploration;
    let frames = clips.iter().map(|clip| clip.frames).sum();
    let front = rows.iter().filter(|row| row.front.any()).count();
    let (width, height) = exploration.size;
    let fact = |name, value, note| HeadingFigure { name, value, note };
    let count = |count: usize| grouped(count as u64);
    let mut facts = vec![
        fact(
            "Designs",
            count(rows.len()),
            match axes.as_slice() {
                [] => "nothing varies".to_owned(),
                axes => format!("{} varied", counted(axes.len(), "setting")),
            },
        ),
        fact("On a front", count(front), "no other one is better".to_owned()),
        fact("Frames", grouped(frames), counted(clips.len(), "clip")),
        fact("Frame", format!("{width}×{height}"), "pixels".to_owned()),
        clock(exploration),
    ];
    let link = exploration.link_bits_per_second.map(LinkRate);
    let note = "behind each design".to_owned();
    facts.extend(link.map(|rate| HeadingFigure { name: "Link", value: rate.to_string(), note }));
    facts.extend(cells(exploration));
    facts
}

/// Returns the library of the process, if there is one.
fn cells(exploration: &Exploration) -> Option<HeadingFigure> {
    let value = exploration.library.clone()?;
    let note = match exploration.energy_rate {
        Some(rate) => format!("power at a rate of {rate}/s"),
        None => "energy not measured".to_owned(),
    };
    Some(HeadingFigure { name: "Cells", value, note })
}

/// Returns the clock of the frame rates.
fn clock(exploration: &Exploration) -> HeadingFigure {
    let of_rows = || exploration.rows.iter().filter_map(|row| row.speed);
    let is_limited = exploration.library.is_some();
    let (value, note) = match (exploration.clock_mhz, of_rows().next()) {
        (Some(mhz), _) if is_limited => (format!("{mhz} MHz"), "or the highest of the cells"),
        (Some(mhz), _) => (format!("{mhz} MHz"), "given by the space"),
        (None, Some(_)) => {
            let slowest = of_rows().map(|speed| speed.clock_mhz).fold(f64::INFINITY, f64::min);
            let fastest = of_rows().map(|speed| speed.clock_mhz).fold(0.0, f64::max);
            let [slowest, fastest] = [slowest, fastest].map(|mhz| real_number(mhz, 0));
            let both = format!("{slowest} to {fastest} MHz");
            let value = if slowest == fastest { format!("{slowest} MHz") } else { both };
            (
                value,
                if is_limited { "the highest of the cells" } else { "estimated for each design" },
            )
        }
        (None, None) if exploration.awaited_areas > 0 => (MISSING.to_owned(), "not known yet"),
        (None, None) => (MISSING.to_owned(), "not known without synthesis"),
    };
    HeadingFigure { name: "Clock", value, note: note.to_owned() }
}
