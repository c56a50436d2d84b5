// SPDX-License-Identifier: MIT OR Apache-2.0
//! Error against speed, area and bytes: every point of the exploration is a mark.

use std::collections::BTreeMap;

use super::axis::Axis;
use super::colour::Grouping;
use super::plot::{Field, Line, Mark, Plot, staircase, text};
use crate::front::front;
use crate::row::real;
use crate::{Exploration, Row};

/// What a plot shows.
struct Scatter {
    id: &'static str,
    title: &'static str,
    x: Measure,
    y: Measure,
    /// The fronts that are known; otherwise that of the two measures.
    known: Option<fn(&Row) -> bool>,
}

type Of = Box<dyn Fn(&Row) -> Option<f64>>;

/// A figure of a point.
struct Measure {
    title: String,
    of: Of,
    /// Whether small is good.
    low: bool,
    /// Whether the axis starts at zero.
    zero: bool,
}

impl Measure {
    fn new(title: &str, low: bool, zero: bool, of: impl Fn(&Row) -> Option<f64> + 'static) -> Self {
        Self { title: title.to_owned(), of: Box::new(of), low, zero }
    }

    fn axis(&self, rows: &[&Row]) -> Axis {
        let values = rows.iter().filter_map(|row| (self.of)(row));
        if self.zero { Axis::from_zero(values) } else { Axis::free(values) }
    }
}

/// Every plot of points, in order.
pub(crate) fn plots(
    exploration: &Exploration,
    rows: &[&Row],
    groupings: &[Grouping],
    titles: &[String],
) -> Vec<Plot> {
    let flips = || {
        Measure::new("flipped actions, %", true, true, |row| Some(100.0 * row.figures.action_flips))
    };
    let bytes = || Measure::new("bytes per frame", true, false, |row| Some(row.bytes_per_frame));
    let mhz = exploration.clock_mhz;
    let rate = move |row: &Row| Some(f64::from(mhz) * 1e6 / real(row.clocks_per_frame));
    let mut scatters = vec![Scatter {
        id: "speed",
        title: "Error against speed",
        x: Measure::new(&format!("frames/s at {mhz} MHz"), false, false, rate),
        y: flips(),
        known: Some(|row| row.front.speed),
    }];
    if rows.iter().any(|row| row.silicon.is_some()) {
        scatters.push(Scatter {
            id: "area",
            title: "Error against area",
            x: Measure::new("LUTs of the array", true, false, Row::luts),
            y: flips(),
            known: Some(|row| row.front.area),
        });
    }
    let stale = |row: &Row| Some(100.0 * row.figures.staleness.share);
    scatters.push(Scatter {
        id: "stale",
        title: "Staleness against bytes",
        x: bytes(),
        y: Measure::new("stale relevant regions, %", true, true, stale),
        known: None,
    });
    let likeness = |row: &Row| Some(row.figures.ssim_ideal);
    scatters.push(Scatter {
        id: "picture",
        title: "Picture against bytes",
        x: bytes(),
        y: Measure::new("SSIM to the ideal's screen", false, false, likeness),
        known: None,
    });
    scatters.iter().map(|scatter| scatter.plot(rows, groupings, titles)).collect()
}

impl Scatter {
    fn plot(&self, rows: &[&Row], groupings: &[Grouping], titles: &[String]) -> Plot {
        let field = Field { x: self.x.axis(rows), y: self.y.axis(rows) };
        let on_front = self.on_front(rows);
        let mut marks = Vec::new();
        let mut steps = Vec::new();
        for (index, row) in rows.iter().enumerate() {
            let Some((x, y)) = (self.x.of)(row).zip((self.y.of)(row)) else { continue };
            let Some((x, y)) = field.place(x, y) else { continue };
            if on_front[index] {
                steps.push((x, y));
            }
            let title = titles.get(index).cloned().unwrap_or_default();
            marks.push(mark(row, index, (x, y), on_front[index], groupings, title));
        }
        // What is drawn later lies above.
        marks.sort_by_key(|mark| mark.front);
        stack(&mut marks);
        let path = staircase(&steps, self.x.low, self.y.low);
        let logarithmic = |axis: Axis, measure: &Measure| {
            let scale = if axis.logarithmic() { " (log)" } else { "" };
            format!("{}{scale}", measure.title)
        };
        Plot {
            id: self.id.to_owned(),
            title: self.title.to_owned(),
            x_title: logarithmic(field.x, &self.x),
            y_title: logarithmic(field.y, &self.y),
            x_ticks: field.x_ticks(),
            y_ticks: field.y_ticks(),
            lines: vec![Line { path, class: "front".to_owned(), shape: "", label: String::new() }],
            marks,
            by_axis: true,
            ..Plot::default()
        }
    }

    fn on_front(&self, rows: &[&Row]) -> Vec<bool> {
        if let Some(known) = self.known {
            return rows.iter().map(|row| known(row)).collect();
        }
        let small = |measure: &Measure, row: &Row| {
            (measure.of)(row).map(|value| if measure.low { value } else { -value })
        };
        let both = |row: &&Row| [small(&self.x, row), small(&self.y, row)];
        front(&rows.iter().map(both).collect::<Vec<_>>())
    }
}

/// The mark of a row.
fn mark(
    row: &Row,
    index: usize,
    (x, y): (f64, f64),
    front: bool,
    groupings: &[Grouping],
    title: String,
) -> Mark {
    let group = |grouping: &Grouping| grouping.of_row.get(index).copied().unwrap_or(0);
    let groups: Vec<String> = groupings.iter().map(|one| group(one).to_string()).collect();
    let chosen = groupings.iter().find(|grouping| grouping.chosen);
    let (class, shape) = super::colour::look(chosen.map_or(0, group));
    Mark {
        number: row.number,
        x: text(x),
        y: text(y),
        front,
        scale: None,
        class,
        shape,
        groups: groups.join(" "),
        title,
    }
}

/// Marks of one place name each other, and those that look different become rings around each other.
pub(crate) fn stack(marks: &mut [Mark]) {
    let place = |mark: &Mark| (mark.x.clone(), mark.y.clone());
    let look = |mark: &Mark| (mark.class.clone(), mark.shape);
    // The numbers of a place, and its looks from above.
    let mut at: BTreeMap<_, (Vec<usize>, Vec<_>)> = BTreeMap::new();
    for mark in marks.iter().rev() {
        let (numbers, looks) = at.entry(place(mark)).or_default();
        numbers.push(mark.number);
        if !looks.contains(&look(mark)) {
            looks.push(look(mark));
        }
    }
    for mark in marks {
        let Some((numbers, looks)) = at.get(&place(mark)) else { continue };
        let mut others: Vec<usize> = numbers.clone();
        others.retain(|number| *number != mark.number);
        others.sort_unstable();
        if others.is_empty() {
            continue;
        }
        let named: Vec<String> = others.iter().take(12).map(usize::to_string).collect();
        let more = if others.len() > named.len() { " and more" } else { "" };
        mark.title += &format!("\nat the same place: {}{more}", named.join(", "));
        let above = looks.iter().position(|other| *other == look(mark)).unwrap_or(0);
        let above = u8::try_from(above).unwrap_or(u8::MAX);
        mark.scale = (above > 0).then(|| text(1.0 + f64::from(above) / 2.0));
    }
}
