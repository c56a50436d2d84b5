// SPDX-License-Identifier: MIT OR Apache-2.0
//! The setup and the findings of an exploration in a few lines.

use std::cmp::Ordering;

use foveate_link::LinkRate;
use foveate_pictures::page::HeadingFigure;
use foveate_pictures::page::number_text::{MISSING, counted, grouped, percent, real_number};

use super::setting::PointSettings;
use crate::objective::{FrontObjectives, Objective};
use crate::{DesignRow, Exploration};

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

/// Returns the figures of the heading.
pub(crate) fn facts(exploration: &Exploration) -> Vec<HeadingFigure> {
    let Exploration { rows, refused, clips, axes, .. } = exploration;
    let frames = clips.iter().map(|clip| clip.frames).sum();
    let front = rows.iter().filter(|row| row.front.all).count();
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
        fact("Pareto front", count(front), format!("of {}", exploration.front_figures())),
        fact("Refused", count(refused.len()), "combinations".to_owned()),
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
        (None, None) => (MISSING.to_owned(), "not known without synthesis"),
    };
    HeadingFigure { name: "Clock", value, note: note.to_owned() }
}

/// Describes the ends of the front.
pub(crate) fn findings(exploration: &Exploration, settings: &PointSettings) -> Vec<String> {
    let rows = &exploration.rows;
    let FrontObjectives { speed: fast, area: small, .. } = exploration.front_objectives();
    let front = || rows.iter().filter(|row| row.front.all);
    let by_error = |one: &&DesignRow, other: &&DesignRow| {
        one.figures.action_flips.total_cmp(&other.figures.action_flips)
    };
    let speed = |row: &DesignRow| match row.speed {
        Some(speed) => speed.text(),
        None => format!("{} clocks per frame", grouped(row.clocks_per_frame)),
    };
    let flips =
        |row: &DesignRow| format!("{} % flipped actions", percent(row.figures.action_flips));
    let mut found = Vec::new();
    let mut say = |what: &str, row: Option<&DesignRow>| {
        found.extend(row.map(|row| {
            let settings = settings.settings_text(row, None);
            let (flips, speed, costs) = (flips(row), speed(row), cost_text(row));
            format!("{what}: point {} ({settings}), {flips} at {speed}{costs}.", row.number)
        }));
    };
    say("Smallest error", front().min_by(by_error));
    let fastest = front().max_by(|one, other| {
        let order = fast.value_of(one).partial_cmp(&fast.value_of(other));
        order.unwrap_or(Ordering::Equal).then_with(|| by_error(other, one))
    });
    say("Fastest", fastest);
    say("Smallest area", least(front(), small));
    say("Least energy", least(rows.iter().filter(|row| row.front.energy), Objective::Energy));
    found
}

/// Returns the point with the smallest value of an objective.
fn least<'a>(
    rows: impl Iterator<Item = &'a DesignRow>,
    objective: Objective,
) -> Option<&'a DesignRow> {
    let known = rows.filter_map(|row| Some((objective.value_of(row)?, row)));
    known.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, row)| row)
}

/// Returns the known costs of a point, each behind a comma.
pub(crate) fn cost_text(row: &DesignRow) -> String {
    let luts = row.luts().map(|luts| format!(", {} LUTs", real_number(luts, 0)));
    let mm2 = Objective::Mm2.value_of(row).map(|mm2| format!(", {mm2:.3} mm²"));
    let energy = Objective::Energy.value_of(row).map(|nj| format!(", {nj:.3} nJ per region"));
    [luts, mm2, energy].into_iter().flatten().collect()
}
