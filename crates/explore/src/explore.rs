// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a space and clips to a folder of tables, fronts, configurations and one page.

use std::fs;
use std::path::Path;

use foveate_design::Design;
use foveate_files::tables::Table;
use foveate_staging::write_file;

use crate::cost::Synthesized;
use crate::folder::{UNFINISHED, claim, mark};
use crate::measure::Measured;
use crate::objective::mark_fronts;
use crate::row::DesignRow;
use crate::store::Store;
use crate::table::{errors, point};
use crate::work::Work;
use crate::{ClipRow, Exploration, ExploreError, Hooks, Request, Synthesizer};

/// Runs an exploration and writes `output`. Finished results are kept there, so an interrupted run
/// can continue.
///
/// # Errors
/// When an input cannot be read, no point is a valid design, the folder holds something else or cannot
/// be written, or `hooks` cancels.
pub fn explore(
    request: &Request<'_>,
    output: &Path,
    hooks: &dyn Hooks,
) -> Result<Exploration, ExploreError> {
    let space = request.space;
    let Work { footage, points, refused, looks, look_of } = Work::new(request, None, hooks)?;
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
        // A space has a design.
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

/// Area and speed of every design, and what Yosys said of those without one: one of many that fails does not
/// lose the others.
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
    write_file(&output.join("points.csv"), points.csv().as_bytes())?;
    let parquet = output.join("points.parquet");
    write_file(&parquet, &points.parquet("points").map_err(ExploreError::io("write", &parquet))?)?;
    let pareto = table(&mut rows.iter().filter(|row| row.front.all));
    write_file(&output.join("pareto.csv"), pareto.csv().as_bytes())?;
    let clips = exploration.clips.iter().zip(measured).flat_map(|(clip, measured)| {
        rows.iter().map(move |row| {
            let figures = measured[look_of[row.number - 1]].tally.figures();
            let mut cells = crate::table::names(row.number, &clip.name);
            cells.extend(errors(&figures));
            cells
        })
    });
    write_file(&output.join("clips.csv"), Table::of(clips).csv().as_bytes())?;
    let designs = output.join("designs");
    fs::create_dir_all(&designs).map_err(ExploreError::io("make the folder", &designs))?;
    // Numbers of an earlier, larger space would belong to other points.
    for number in rows.len() + 1.. {
        let surplus = designs.join(format!("{number}.toml"));
        if !surplus.exists() {
            break;
        }
        fs::remove_file(&surplus).map_err(ExploreError::io("remove", &surplus))?;
    }
    for row in rows {
        let name = designs.join(format!("{}.toml", row.number));
        write_file(&name, row.config.to_toml().as_bytes())?;
    }
    write_file(&output.join("report.html"), crate::report::page(exploration)?.as_bytes())?;
    // Last, since it says that all is there. Plain data with text keys: this cannot fail.
    let json = serde_json::to_string_pretty(exploration)
        .expect("it has no map with other keys than text")
        + "\n";
    mark(output, &json)
}
