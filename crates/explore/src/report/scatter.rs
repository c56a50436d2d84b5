// SPDX-License-Identifier: MIT OR Apache-2.0
//! The plots of error against speed, area and bytes ([`plots`]), with a mark for every point of
//! the exploration. The colour of a mark comes from a [`PointGrouping`], one for each axis, of
//! which the page shows one at a time.

use super::setting::{PointSettings, axes_set};
use crate::objective::{BetterDirection, FrontObjectives, Objective, unbeaten_rows};
use crate::{DesignFront, DesignRow, Exploration};
use foveate_output::page::{
    COLOUR_COUNT, PagePlot, PlotAxes, PlotAxis, PlotLine, PlotMark, coordinate_text, front_path,
    group_look, nest_marks,
};
use std::collections::{BTreeMap, BTreeSet};

/// A plot of two objectives, with the front of both.
struct ScatterPlot {
    id: &'static str,
    title: &'static str,
    x: ObjectiveAxis,
    y: ObjectiveAxis,
}

struct ObjectiveAxis {
    objective: Objective,
    title: String,
    /// The factor from the unit of the objective to that of the axis; positive, so that the order
    /// stays.
    scale: f64,
}

impl ObjectiveAxis {
    /// Creates the axis of an objective, in a unit that people use.
    fn from_objective(objective: Objective, exploration: &Exploration) -> Self {
        let (title, scale) = match objective {
            Objective::Error => ("flipped actions, %".to_owned(), 100.0),
            Objective::Speed => (speed_title(exploration), 1.0),
            Objective::PerClock => ("frames per million clocks".to_owned(), 1e6),
            Objective::DeviceShare => ("share of the device, %".to_owned(), 100.0),
            Objective::Mm2 => ("mm² of the array".to_owned(), 1.0),
            Objective::Energy => ("nJ per region and frame".to_owned(), 1.0),
            Objective::Stale => ("stale relevant regions, %".to_owned(), 100.0),
            Objective::Bytes => ("bytes per frame".to_owned(), 1.0),
            Objective::Ssim => ("SSIM to the ideal's screen".to_owned(), 1.0),
        };
        Self { objective, title, scale }
    }

    fn value(&self, row: &DesignRow) -> Option<f64> {
        self.objective.value_of(row).map(|value| value * self.scale)
    }

    fn axis(&self, rows: &[&DesignRow]) -> PlotAxis {
        let values = rows.iter().filter_map(|row| self.value(row));
        match self.objective {
            Objective::Error | Objective::Stale => PlotAxis::starting_at_zero(values),
            _ => PlotAxis::with_free_start(values),
        }
    }

    /// Returns whether the better end of the axis is its low one.
    fn is_low_better(&self) -> bool {
        self.objective.better_direction() == BetterDirection::Smaller
    }
}

fn speed_title(exploration: &Exploration) -> String {
    match (exploration.clock_mhz, &exploration.library) {
        (Some(mhz), None) => format!("frames/s at {mhz} MHz"),
        (Some(mhz), Some(_)) => format!("frames/s at {mhz} MHz or the highest clock of the cells"),
        (None, None) => "frames/s at the estimated clock".to_owned(),
        (None, Some(_)) => "frames/s at the highest clock of the cells".to_owned(),
    }
}

pub(crate) fn plots(
    exploration: &Exploration,
    rows: &[&DesignRow],
    groupings: &[PointGrouping],
    titles: &[String],
) -> Vec<PagePlot> {
    use Objective::{Bytes, Energy, Error, Ssim, Stale};
    let FrontObjectives { speed, area, has_areas } = exploration.front_objectives();
    let scatter = |id, title, x, y| {
        let [x, y] = [x, y].map(|objective| ObjectiveAxis::from_objective(objective, exploration));
        ScatterPlot { id, title, x, y }
    };
    let mut scatters = vec![scatter("speed", "Error against speed", speed, Error)];
    if has_areas {
        scatters.push(scatter("area", "Error against area", area, Error));
    }
    if rows.iter().any(|row| row.energy().is_some()) {
        scatters.push(scatter("energy", "Error against energy", Energy, Error));
    }
    scatters.push(scatter("stale", "Staleness against bytes", Bytes, Stale));
    scatters.push(scatter("picture", "Picture against bytes", Bytes, Ssim));
    scatters.iter().map(|scatter| scatter.plot(rows, groupings, titles)).collect()
}

impl ScatterPlot {
    fn plot(
        &self,
        rows: &[&DesignRow],
        groupings: &[PointGrouping],
        titles: &[String],
    ) -> PagePlot {
        let field = PlotAxes { x: self.x.axis(rows), y: self.y.axis(rows) };
        let on_front = unbeaten_rows(rows, [self.x.objective, self.y.objective]);
        let front = std::iter::zip(rows, &on_front).filter(|(_, on)| **on).map(|(row, _)| *row);
        let front = DesignFront::new(("", ""), front);
        let named: BTreeSet<usize> = match self.y.objective {
            Objective::Error => front.named_rows().map(|row| row.number).collect(),
            _ => BTreeSet::new(),
        };
        let mut marks = Vec::new();
        let mut steps = Vec::new();
        for (index, row) in rows.iter().enumerate() {
            let Some((x, y)) = self.x.value(row).zip(self.y.value(row)) else { continue };
            let Some((x, y)) = field.coordinates(x, y) else { continue };
            if on_front[index] {
                steps.push((x, y));
            }
            let title = titles[index].clone();
            let label = named.get(&row.number).map(usize::to_string).unwrap_or_default();
            let front = on_front[index];
            let mark = mark(row, index, (x, y), groupings);
            marks.push(PlotMark { front, title, label, ..mark });
        }
        // Marks that are drawn later lie above the others.
        marks.sort_by_key(|mark| mark.front);
        stack_marks(&mut marks);
        let path = front_path(&steps, self.x.is_low_better(), self.y.is_low_better());
        PagePlot {
            lines: vec![PlotLine {
                path,
                class: "front".to_owned(),
                shape: "",
                label: String::new(),
            }],
            marks,
            by_axis: true,
            ..PagePlot::new(self.id, self.title, &field, [&self.x.title, &self.y.title])
        }
    }
}

fn mark(
    row: &DesignRow,
    index: usize,
    (x, y): (f64, f64),
    groupings: &[PointGrouping],
) -> PlotMark {
    let group = |grouping: &PointGrouping| grouping.of_row[index];
    let groups: Vec<String> = groupings.iter().map(|one| group(one).to_string()).collect();
    let chosen = groupings.iter().find(|grouping| grouping.is_chosen);
    let (class, shape) = group_look(chosen.map_or(0, group));
    PlotMark {
        id: row.number.to_string(),
        x: coordinate_text(x),
        y: coordinate_text(y),
        hollow: !row.qualifies(),
        class,
        shape,
        groups: groups.join(" "),
        ..PlotMark::default()
    }
}

/// Adds to every mark the names of other marks at the same place. Marks with different looks become
/// rings around each other.
pub(crate) fn stack_marks(marks: &mut [PlotMark]) {
    let place = |mark: &PlotMark| (mark.x.clone(), mark.y.clone());
    let mut at: BTreeMap<_, Vec<String>> = BTreeMap::new();
    for mark in marks.iter() {
        at.entry(place(mark)).or_default().push(mark.id.clone());
    }
    for mark in marks.iter_mut() {
        let Some(numbers) = at.get(&place(mark)) else { continue };
        let mut others: Vec<String> = numbers.clone();
        others.retain(|number| *number != mark.id);
        if others.is_empty() {
            continue;
        }
        // Numbers without leading zeros sort by length and then by text.
        others.sort_unstable_by_key(|number| (number.len(), number.clone()));
        let named = &others[..others.len().min(12)];
        let more = if others.len() > named.len() { " and more" } else { "" };
        mark.title += &format!("\nat the same place: {}{more}", named.join(", "));
    }
    nest_marks(marks, 1.0);
}

/// The number of groups that can be told apart; further groups are grey.
const MAX_GROUPS: usize = 2 * COLOUR_COUNT;

pub(crate) struct PointGrouping {
    /// The name of the axis.
    pub(crate) name: String,
    /// True if the page starts with this grouping.
    pub(crate) is_chosen: bool,
    pub(crate) groups: Vec<PointGroup>,
    pub(crate) of_row: Vec<usize>,
}

pub(crate) struct PointGroup {
    /// The value that the points have in common.
    pub(crate) label: String,
    /// The CSS class of the colour.
    pub(crate) class: String,
    /// Shape of the marks.
    pub(crate) shape: &'static str,
}

/// Returns every grouping of the rows. The chosen one has the most groups that can be told apart.
/// If every point differs from the start in one axis, the only grouping is by that axis.
pub(crate) fn groupings(settings: &PointSettings, rows: &[&DesignRow]) -> Vec<PointGrouping> {
    let axes = 0..settings.names.len();
    let of_axis = |axis: usize| {
        let values: Vec<String> = rows.iter().map(|row| settings.value(row, axis)).collect();
        PointGrouping::new(settings.names[axis].clone(), &values)
    };
    let mut all: Vec<PointGrouping> = Vec::new();
    if settings.is_one_at_a_time {
        let changed =
            |row: &&DesignRow| axes_set(row).next().map(|axis| settings.names[axis].clone());
        let values = rows.iter().map(|row| changed(row).unwrap_or_else(|| "the start".to_owned()));
        let values: Vec<String> = values.collect();
        all.push(PointGrouping::new("changed setting".to_owned(), &values));
    } else {
        all.extend(axes.map(of_axis));
    }
    let count =
        |grouping: &PointGrouping| Some(grouping.groups.len()).filter(|count| *count <= MAX_GROUPS);
    let best = all.iter().filter_map(count).max();
    let first = all.iter().position(|grouping| count(grouping) == best).unwrap_or(0);
    if let Some(grouping) = all.get_mut(first) {
        grouping.is_chosen = true;
    }
    all
}

impl PointGrouping {
    fn new(name: String, values: &[String]) -> Self {
        let mut labels: Vec<String> = Vec::new();
        for value in values {
            if !labels.contains(value) {
                labels.push(value.clone());
            }
        }
        let number = |label: &String| label.parse::<f64>().ok().filter(|value| value.is_finite());
        if let Some(mut numbers) = labels
            .iter()
            .map(|label| Some((number(label)?, label.clone())))
            .collect::<Option<Vec<_>>>()
        {
            numbers.sort_by(|one, other| one.0.total_cmp(&other.0));
            labels = numbers.into_iter().map(|(_, label)| label).collect();
        }
        let place = |value: &String| labels.iter().position(|label| label == value);
        let group = |value| place(value).expect("every value has a label").min(MAX_GROUPS);
        let of_row = values.iter().map(group).collect();
        let more = labels.len() > MAX_GROUPS;
        labels.truncate(MAX_GROUPS);
        let label =
            |label: String| if label.is_empty() { "same as the start".to_owned() } else { label };
        let rest = more.then(|| "others".to_owned());
        let labels = labels.into_iter().map(label).chain(rest);
        let group = |(index, label)| {
            let (class, shape) = group_look(index);
            PointGroup { label, class, shape }
        };
        Self { name, is_chosen: false, groups: labels.enumerate().map(group).collect(), of_row }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_in_order_and_the_rest_is_grey() {
        let grouping =
            PointGrouping::new("fold".to_owned(), &["16", "4", "", "4"].map(str::to_owned));
        let labels: Vec<&str> = grouping.groups.iter().map(|group| group.label.as_str()).collect();
        assert_eq!(labels, ["16", "4", "same as the start"]);
        assert_eq!(grouping.of_row, [0, 1, 2, 1]);
        let many = (0..40).rev().map(|value| value.to_string()).collect::<Vec<_>>();
        let many = PointGrouping::new(String::new(), &many);
        assert_eq!((many.groups.len(), many.of_row[39], many.of_row[0]), (15, 0, 14));
        assert_eq!(many.groups[0].label, "0");
        let last = many.groups.last().map(|group| (group.label.as_str(), group.class.as_str()));
        assert_eq!(last, Some(("others", "k7")));
        assert_eq!((many.groups[7].class.as_str(), many.groups[7].shape), ("k0", "box"));
    }
}
