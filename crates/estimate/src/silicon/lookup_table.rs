// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table of a liberty file: energies or times by the transition time of an input and the load of an
//! output.

use super::liberty_text::LibertyGroup;
use std::collections::BTreeMap;

/// The meaning of an index of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TableAxis {
    Slew,
    Load,
}

/// The templates of a library, by name: the meaning of each index and its default values.
#[derive(Clone, Debug, Default)]
pub(super) struct TableTemplates(BTreeMap<String, Vec<(TableAxis, Vec<f64>)>>);

/// A table of energies or times. Between its points it is linear, and beyond them it goes on as in
/// the last interval, as OpenSTA reads it.
#[derive(Clone, Debug, PartialEq)]
pub struct LookupTable {
    slews: Vec<f64>,
    loads: Vec<f64>,
    /// The values, for the first slew at all loads, then for the next one.
    values: Vec<f64>,
}

impl TableTemplates {
    pub(super) fn of_library(library: &LibertyGroup) -> Self {
        let kinds = ["lu_table_template", "power_lut_template"];
        let groups = kinds.iter().flat_map(|kind| library.groups_of(kind));
        let template = |group: &LibertyGroup| {
            let axis = |number: u32| {
                let axis = match group.attribute(&format!("variable_{number}"))? {
                    "input_net_transition" | "input_transition_time" => TableAxis::Slew,
                    "total_output_net_capacitance" => TableAxis::Load,
                    // A table of constraints, which has no energy and no transition.
                    _ => return None,
                };
                Some((axis, index_values(group, number).unwrap_or_default()))
            };
            (group.name.clone(), (1..=2).map_while(axis).collect())
        };
        Self(groups.map(template).collect())
    }
}

impl LookupTable {
    /// Reads the table of a group such as `rise_power (NAME) { ... }`. Returns `None` if its
    /// template is not known or its values are not as many as its points.
    pub(super) fn from_group(group: &LibertyGroup, templates: &TableTemplates) -> Option<Self> {
        let values: Vec<f64> = numbers(group.list("values")?)?;
        if let [value] = values[..] {
            return Some(Self { slews: vec![0.0], loads: vec![0.0], values: vec![value] });
        }
        let mut axes = templates.0.get(&group.name)?.clone();
        for (number, (_, points)) in (1..).zip(&mut axes) {
            *points = index_values(group, number).unwrap_or_else(|| std::mem::take(points));
        }
        let points = |wanted: TableAxis| {
            let axis = axes.iter().find(|(axis, _)| *axis == wanted);
            axis.map_or(vec![0.0], |(_, points)| points.clone())
        };
        let (slews, loads) = (points(TableAxis::Slew), points(TableAxis::Load));
        let is_sorted = |points: &[f64]| !points.is_empty() && points.is_sorted_by(|a, b| a < b);
        if !is_sorted(&slews) || !is_sorted(&loads) || values.len() != slews.len() * loads.len() {
            return None;
        }
        let has_loads_first = axes.first().is_some_and(|(axis, _)| *axis == TableAxis::Load);
        let values = match has_loads_first {
            false => values,
            true => {
                let place = |slew: usize, load: usize| load * slews.len() + slew;
                let places = (0..slews.len()).flat_map(|slew| {
                    (0..loads.len()).map(move |load| place(slew, load)).collect::<Vec<_>>()
                });
                places.map(|place| values[place]).collect()
            }
        };
        Some(Self { slews, loads, values })
    }

    /// Returns the value for a transition time and a load, both in the units of the library.
    #[must_use]
    pub fn value(&self, slew: f64, load: f64) -> f64 {
        let (slew_at, slew_part) = interval(&self.slews, slew);
        let (load_at, load_part) = interval(&self.loads, load);
        let value = |slew: usize, load: usize| {
            let (slew, load) = (slew.min(self.slews.len() - 1), load.min(self.loads.len() - 1));
            self.values[slew * self.loads.len() + load]
        };
        let along_load = |slew: usize| {
            let (low, high) = (value(slew, load_at), value(slew, load_at + 1));
            low + (high - low) * load_part
        };
        let (low, high) = (along_load(slew_at), along_load(slew_at + 1));
        low + (high - low) * slew_part
    }
}

/// Returns the interval of sorted points in which a place is, or the nearest one, and the place in
/// it: 0 at its begin and 1 at its end.
fn interval(points: &[f64], place: f64) -> (usize, f64) {
    if points.len() < 2 {
        return (0, 0.0);
    }
    let after = points.partition_point(|&point| point <= place);
    let at = after.saturating_sub(1).min(points.len() - 2);
    (at, (place - points[at]) / (points[at + 1] - points[at]))
}

fn index_values(group: &LibertyGroup, number: u32) -> Option<Vec<f64>> {
    numbers(group.list(&format!("index_{number}"))?)
}

/// Reads the numbers of texts in which commas or spaces separate them.
fn numbers(texts: &[String]) -> Option<Vec<f64>> {
    let is_between = |letter: char| letter == ',' || letter == '\\' || letter.is_whitespace();
    let words =
        texts.iter().flat_map(|text| text.split(is_between)).filter(|word| !word.is_empty());
    words.map(|word| word.parse().ok().filter(|number: &f64| number.is_finite())).collect()
}

#[cfg(test)]
mod tests {
    use super::super::liberty_text::parse_tables;
    use super::*;

    const TABLES: &str = r#"library (a) {
        power_lut_template (slew_load) { variable_1 : input_transition_time; variable_2 : total_output_net_capacitance;
            index_1 ("0, 1"); index_2 ("0, 10, 20"); }
        power_lut_template (load_slew) { variable_1 : total_output_net_capacitance; variable_2 : input_transition_time;
            index_1 ("0, 10, 20"); index_2 ("0, 1"); }
        power_lut_template (slew) { variable_1 : "input_transition_time"; index_1 ("0, 1"); }
        rise_power (slew_load) { values ("1, 2, 4", \
            "11, 12, 14"); }
        rise_power (load_slew) { values ("1, 11", "2, 12", "4, 14"); }
        rise_power (slew) { index_1 ("0, 2"); values ("1 11"); }
        rise_power (scalar) { values ("7"); }
        rise_power (other) { values ("7, 8"); }
        rise_power (slew) { values ("7, 8, 9"); }
        rise_power (slew) { values ("7, x"); }
        rise_power (slew) { index_1 ("1, 1"); values ("7, 8"); }
        rise_power (slew) { }
        rise_power (slew) { index_1 (""); values (""); }
        rise_power (slew) { values (""); }
    }"#;

    #[test]
    fn tables_are_linear_between_and_beyond_their_points() {
        let library = parse_tables(TABLES).unwrap();
        let templates = TableTemplates::of_library(&library);
        let groups = library.groups_of("rise_power");
        let tables: Vec<_> =
            groups.map(|group| LookupTable::from_group(group, &templates)).collect();
        let value = |table: usize, slew, load| tables[table].as_ref().unwrap().value(slew, load);
        for table in [0, 1] {
            for (slew, load, expected) in [
                (0.0, 0.0, 1.0),
                (1.0, 10.0, 12.0),
                (0.5, 15.0, 8.0),
                (2.0, 30.0, 26.0),
                (-0.1, 0.0, 0.0),
            ] {
                let found = value(table, slew, load);
                assert!((found - expected).abs() < 1e-12, "{table} {slew} {load}: {found}");
            }
        }
        assert_eq!((value(2, 1.0, 99.0), value(3, 1.0, 99.0)), (6.0, 7.0));
        assert!(tables[4..].iter().all(Option::is_none), "{tables:?}");
    }
}
