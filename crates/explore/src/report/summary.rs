// SPDX-License-Identifier: MIT OR Apache-2.0
//! The setup and the findings of an exploration in a few lines.

use crate::link::LinkRate;
use foveate_output::{
    number_text::{MISSING, counted, grouped, real_number},
    page::HeadingFigure,
};

use crate::Exploration;

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
