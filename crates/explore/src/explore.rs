// SPDX-License-Identifier: MIT OR Apache-2.0
//! An exploration: it measures a space over clips, and writes a folder of tables, fronts,
//! configurations and one page.

use std::path::Path;

use foveate_design::Design;
use foveate_files::tables::Table;

use crate::cost::Synthesized;
use crate::folder::{MARK, UNFINISHED, claim, continued, mark};
use crate::measure::Measured;
use crate::objective::mark_fronts;
use crate::row::DesignRow;
use crate::store::Store;
use crate::table::{errors, point};
use crate::work::Work;
use crate::{ClipRow, Exploration, ExploreError, Hooks, Request, Synthesizer};

/// The names of the tables and of the page.
const POINTS: &str = "points.csv";
const POINTS_PARQUET: &str = "points.parquet";
const PARETO: &str = "pareto.csv";
const CLIPS: &str = "clips.csv";
const REPORT: &str = "report.html";
const TABLES: [&str; 5] = [POINTS, POINTS_PARQUET, PARETO, CLIPS, REPORT];

/// Runs an exploration and writes `output`. Finished results are kept there, so an interrupted run
/// can continue.
///
/// # Errors
/// Fails if an input cannot be read, no point is a valid design, the folder holds something else or
/// cannot be written, or `hooks` cancels.
pub fn explore(
    request: &Request<'_>,
    output: &Path,
    hooks: &dyn Hooks,
) -> Result<Exploration, ExploreError> {
    let space = request.space;
    // The files of designs are not known before the clips have been opened.
    continued(output)?.check(TABLES.into_iter().chain([MARK]))?;
    let Work { footage, points, refused, looks, look_of } = Work::new(request, None, hooks)?;
    // The names are checked now, because writing the files may come hours later.
    let names = (1..=points.len()).map(design_file).chain(TABLES.map(str::to_owned));
    let names: Vec<String> = names.chain([MARK.to_owned()]).collect();
    continued(output)?.check(names.iter().map(String::as_str))?;
    claim(output)?;
    mark(output, UNFINISHED)?;
    let store = Store::open(output)?;
    let designs =
        points.iter().map(|point| point.config.validate()).collect::<Result<Vec<_>, _>>()?;
    let measured = footage.measure(&looks, &store)?;
    let (synthesized, failed) = synthesized(request.synthesizer, &designs, hooks)?;
    let mut rows = Vec::new();
    for (index, (point, (design, synthesized))) in
        points.iter().zip(designs.iter().zip(synthesized)).enumerate()
    {
        let of_point: Vec<&Measured> = measured.iter().map(|clip| &clip[look_of[index]]).collect();
        let settings = point.settings.clone();
        let clock = space.clock_mhz;
        rows.extend(DesignRow::new(index + 1, settings, design, &of_point, synthesized, clock));
    }
    mark_fronts(&mut rows);
    let of_clip = |(subject, measured): (&foveate_footage::Subject, &Vec<Measured>)| ClipRow {
        name: subject.name.clone(),
        // Every space has at least one design.
        frames: measured[0].tally.figures().frames,
    };
    let problem = |(subject, measured): (&foveate_footage::Subject, &Vec<Measured>)| {
        let problem = measured.iter().find_map(|one| one.problem.clone());
        problem.map(|problem| format!("{}: {problem}", subject.name))
    };
    let exploration = Exploration {
        format_version: 4,
        program: concat!("foveate ", env!("CARGO_PKG_VERSION")).to_owned(),
        clips: footage.subjects.iter().zip(&measured).map(of_clip).collect(),
        size: footage.size,
        ideal: space.ideal.to_toml(),
        clock_mhz: space.clock_mhz,
        axes: space.axes.iter().map(|axis| axis.key.clone()).collect(),
        rows,
        refused,
        problems: footage
            .subjects
            .iter()
            .zip(&measured)
            .filter_map(problem)
            .chain(failed)
            .collect(),
    };
    write(&exploration, &measured, &look_of, output)?;
    Ok(exploration)
}

/// Returns the area and speed of every design, and the errors of Yosys. A design that fails does
/// not lose the others.
fn synthesized(
    synthesizer: Option<&Synthesizer>,
    designs: &[Design],
    hooks: &dyn Hooks,
) -> Result<(Vec<Option<Synthesized>>, Vec<String>), ExploreError> {
    let Some(synthesizer) = synthesizer else { return Ok((vec![None; designs.len()], Vec::new())) };
    let areas = synthesizer.areas(designs.iter(), hooks)?;
    let failed =
        areas.iter().enumerate().filter_map(|(index, area)| Some((index + 1, area.err()?)));
    let problems = failed.map(|(point, error)| format!("point {point}: {error}")).collect();
    Ok((areas.iter().map(|area| area.ok().cloned()).collect(), problems))
}

fn write(
    exploration: &Exploration,
    measured: &[Vec<Measured>],
    look_of: &[usize],
    output: &Path,
) -> Result<(), ExploreError> {
    let rows = &exploration.rows;
    let table = |rows: &mut dyn Iterator<Item = &DesignRow>| {
        Table::of(rows.map(|row| point(row, &exploration.axes)))
    };
    let points = table(&mut rows.iter());
    let parquet = points.parquet("points");
    let parquet = parquet.map_err(ExploreError::io("write", &output.join(POINTS_PARQUET)))?;
    let pareto = table(&mut rows.iter().filter(|row| row.front.all));
    let clips = exploration.clips.iter().zip(measured).flat_map(|(clip, measured)| {
        rows.iter().map(move |row| {
            let figures = measured[look_of[row.number - 1]].tally.figures();
            let mut cells = crate::table::names(row.number, &clip.name);
            cells.extend(errors(&figures));
            cells
        })
    });
    let mut files = vec![
        (POINTS.to_owned(), points.csv().into_bytes()),
        (POINTS_PARQUET.to_owned(), parquet),
        (PARETO.to_owned(), pareto.csv().into_bytes()),
        (CLIPS.to_owned(), Table::of(clips).csv().into_bytes()),
    ];
    let design = |row: &DesignRow| (design_file(row.number), row.config.to_toml().into_bytes());
    files.extend(rows.iter().map(design));
    files.push((REPORT.to_owned(), crate::report::page(exploration)?.into_bytes()));
    // This file is written last, because it marks the exploration as complete. It is plain data
    // with text keys, so it cannot fail.
    let json = serde_json::to_string_pretty(exploration)
        .expect("it has no map with other keys than text")
        + "\n";
    files.push((MARK.to_owned(), json.into_bytes()));
    // Designs of an earlier, larger space are removed, because their numbers would belong to other
    // points.
    Ok(continued(output)?.write(&files)?)
}

/// Returns the name of the configuration file of a point.
fn design_file(number: usize) -> String {
    format!("designs/{number}.toml")
}
