// SPDX-License-Identifier: MIT OR Apache-2.0
//! The colours of points: one grouping for each axis. The page shows one grouping at a time.

use foveate_output::page::{COLOUR_COUNT, group_look};

use super::setting::{PointSettings, axes_set};
use crate::DesignRow;

/// The number of groups that can be told apart; further groups are grey.
const MAX_GROUPS: usize = 2 * COLOUR_COUNT;

pub(crate) struct PointGrouping {
    /// The name of the axis.
    pub(crate) name: String,
    /// True if the page starts with this grouping.
    pub(crate) is_chosen: bool,
    pub(crate) groups: Vec<PointGroup>,
    /// The number of the group of each row.
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
