// SPDX-License-Identifier: MIT OR Apache-2.0
//! The settings of points in a readable form.

use foveate_design::DesignConfig;
use toml::{Table, Value};

use crate::point::START_NAME;
use crate::space::plain_text;
use crate::{DesignRow, Exploration};

/// The axes of an exploration, and the values of the start as far as they are known.
pub(crate) struct PointSettings {
    /// The keys, as in a configuration.
    pub(crate) keys: Vec<String>,
    /// The keys in the shortest form that can be told apart.
    pub(crate) names: Vec<String>,
    /// The value of every axis in a point that does not set it.
    start_values: Vec<String>,
    /// The value of every axis in the ideal camera.
    ideal_values: Vec<String>,
    /// True if there are several axes and no point sets more than one.
    pub(crate) is_one_at_a_time: bool,
}

impl PointSettings {
    pub(crate) fn new(exploration: &Exploration) -> Self {
        let keys = exploration.axes.clone();
        let names = keys.iter().map(|key| short_name(key, &keys)).collect();
        let of = |table: Table| -> Vec<String> {
            keys.iter().map(|key| value(&table, key).unwrap_or_default()).collect()
        };
        let untouched = |row: &&DesignRow| row.settings.iter().all(String::is_empty);
        let start = exploration.rows.iter().find(untouched);
        let start = start.and_then(|row| row.config.to_toml().parse::<Table>().ok());
        let ideal = with_defaults(&exploration.ideal).parse::<Table>().unwrap_or_default();
        let (start, ideal) = (of(start.unwrap_or_default()), of(ideal));
        let most = exploration.rows.iter().map(|row| axes_set(row).count()).max().unwrap_or(0);
        Self {
            is_one_at_a_time: keys.len() > 1 && most == 1,
            keys,
            names,
            start_values: start,
            ideal_values: ideal,
        }
    }

    /// Returns the value of an axis for a point: its setting, or the value of the start; empty if
    /// it is unknown.
    pub(crate) fn value(&self, row: &DesignRow, axis: usize) -> String {
        let set = row.settings.get(axis).filter(|text| !text.is_empty()).cloned();
        set.or_else(|| self.start_values.get(axis).cloned()).unwrap_or_default()
    }

    /// Returns the value of an axis in the ideal camera, if it is known.
    pub(crate) fn ideal_value(&self, axis: usize) -> Option<&str> {
        self.ideal_values.get(axis).map(String::as_str).filter(|text| !text.is_empty())
    }

    pub(crate) fn settings_text(&self, row: &DesignRow, without: Option<usize>) -> String {
        let set = row.settings.iter().enumerate();
        let set = set.filter(|(axis, text)| !text.is_empty() && Some(*axis) != without);
        let words = set
            .filter_map(|(axis, text)| self.names.get(axis).map(|name| format!("{name} {text}")));
        let words: Vec<String> = words.collect();
        if words.is_empty() { START_NAME.to_owned() } else { words.join(" · ") }
    }
}

pub(crate) fn axes_set(row: &DesignRow) -> impl Iterator<Item = usize> {
    let set = row.settings.iter().enumerate().filter(|(_, text)| !text.is_empty());
    set.map(|(axis, _)| axis)
}

/// Returns the last part of a key, or the whole key if another key has the same last part.
fn short_name(key: &str, keys: &[String]) -> String {
    fn last(key: &str) -> &str {
        key.rsplit('.').next().unwrap_or(key)
    }
    let same = keys.iter().filter(|other| last(other) == last(key)).count();
    if same > 1 { key.to_owned() } else { last(key).replace('_', " ") }
}

/// Returns the value of a dotted key; numbers index into arrays.
fn value(table: &Table, key: &str) -> Option<String> {
    let mut parts = key.split('.');
    let mut found = table.get(parts.next()?)?;
    for part in parts {
        found = match found {
            Value::Table(table) => table.get(part)?,
            Value::Array(values) => values.get(part.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(plain_text(found))
}

/// Fills in every default of a configuration; returns the text unchanged if it is not valid.
fn with_defaults(toml: &str) -> String {
    let design = DesignConfig::from_toml(toml).and_then(|config| config.validate());
    design.map_or_else(|_| toml.to_owned(), |design| design.config().to_toml())
}

/// Describes the ideal camera in one line. Its windows always see the whole frame, whatever its
/// neighborhood.
pub(crate) fn camera_line(toml: &str) -> String {
    let table = with_defaults(toml).parse::<Table>().unwrap_or_default();
    let of = |key: &str| value(&table, key);
    let mut words = Vec::new();
    words.extend(
        of("region.size").map(|size| format!("regions of {size}×{size}, whole-frame windows")),
    );
    words.extend(of("frame.pixel_bits").map(|bits| format!("{bits} bits")));
    words.extend(of("denoise.filter").map(|filter| match filter.as_str() {
        "none" => "no filter".to_owned(),
        other => other.to_owned(),
    }));
    let spatial = table.get("spatial").and_then(Value::as_array);
    let features = spatial.into_iter().flatten().filter_map(|entry| {
        let entry = entry.as_table()?;
        let level = value(entry, "level").map(|level| format!(" {level}")).unwrap_or_default();
        Some(value(entry, "feature")? + &level)
    });
    words.push(features.collect::<Vec<String>>().join(" + "));
    words.extend(of("temporal.reference").map(|reference| {
        let level = of("temporal.level").map(|level| format!(", level {level}"));
        format!("reference {reference}{}", level.unwrap_or_default())
    }));
    words.retain(|word| !word.is_empty());
    words.join(" · ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_short_unless_that_is_ambiguous() {
        let keys = ["hardware.fold", "spatial.0.level", "temporal.level", "frame.pixel_bits"];
        let keys: Vec<String> = keys.map(str::to_owned).into();
        let names: Vec<String> = keys.iter().map(|key| short_name(key, &keys)).collect();
        assert_eq!(names, ["fold", "spatial.0.level", "temporal.level", "pixel bits"]);
    }

    #[test]
    fn a_camera_is_one_line() {
        let toml = DesignConfig::default().to_toml();
        let line = camera_line(&toml);
        assert!(
            line.starts_with("regions of 8×8, whole-frame windows · 8 bits · median3x3 · edge"),
            "{line}"
        );
        assert_eq!(camera_line("not toml"), "");
        let table: Table = "spatial = [{ level = 7 }]".parse().unwrap();
        assert_eq!(value(&table, "spatial.0.level").as_deref(), Some("7"));
        assert_eq!(value(&table, "spatial.1.level"), None);
    }
}
