// SPDX-License-Identifier: MIT OR Apache-2.0
//! The keys of a configuration, to refuse unknown ones by name and with the nearest known one.

use crate::{
    Combine, DesignError, FeatureKind, Feed, Filter, Irrelevant, MemoryKind, Neighborhood,
    Organization, Payload, Pipelining, Reference, Store, Thresholds,
};
use Takes::{Names, Text};
use toml::{Table, Value};

/// What a key takes.
enum Takes {
    /// In these words.
    Text(&'static str),
    /// One of the names that this lists.
    Names(fn() -> String),
}

/// Every key, dotted, and what it takes; `spatial` is an array of tables.
const KEYS: &[(&str, Takes)] = &[
    ("frame.width", Text("a whole number, 1..=16384")),
    ("frame.height", Text("a whole number, 1..=16384")),
    ("frame.pixel_bits", Text("a whole number, 1..=16")),
    ("region.size", Text("a whole number, 2..=64")),
    ("region.neighborhood", Names(Neighborhood::one_of)),
    ("denoise.filter", Names(Filter::one_of)),
    ("spatial.feature", Names(FeatureKind::one_of)),
    ("spatial.level", Text("a whole number >= 0, in grey levels")),
    ("spatial.min_score", Text("a number >= 0 with at most nine digits after the point")),
    ("spatial.mean_fraction_bits", Text("a whole number, 0..=12")),
    ("decision.combine", Names(Combine::one_of)),
    ("temporal.level", Text("a whole number >= 0, in grey levels")),
    ("temporal.min_count", Text("a whole number >= 0, in pixels")),
    ("temporal.reference", Names(Reference::one_of)),
    ("render.irrelevant", Names(Irrelevant::one_of)),
    ("render.payload", Names(Payload::one_of)),
    ("hardware.organization", Names(Organization::one_of)),
    ("hardware.fold", Text("a whole number >= 1")),
    ("hardware.feed", Names(Feed::one_of)),
    ("hardware.memory", Names(MemoryKind::one_of)),
    ("hardware.pixels_per_clock", Text("1, 2 or 4")),
    ("hardware.pipelining", Names(Pipelining::one_of)),
    ("hardware.store", Names(Store::one_of)),
    ("hardware.forward", Text("true or false")),
    ("hardware.sync", Text("true or false")),
    ("hardware.thresholds", Names(Thresholds::one_of)),
];

/// What the key at `path`, such as `spatial[0].level`, takes.
pub(crate) fn takes(path: &str) -> String {
    let dotted: String = path
        .split('[')
        .enumerate()
        .map(|(part, text)| match part {
            0 => text,
            _ => text.split_once(']').map_or("", |(_, rest)| rest),
        })
        .collect();
    match KEYS.iter().find(|(key, _)| *key == dotted) {
        Some((_, Text(text))) => (*text).to_owned(),
        Some((_, Names(names))) => names(),
        None if path == "spatial" => "an array of tables".to_owned(),
        None => "a table".to_owned(),
    }
}

/// Refuses the first key of `table` that is not one of [`KEYS`].
pub(crate) fn refuse_unknown(table: &Table) -> Result<(), DesignError> {
    for (section, value) in table {
        if !sections().any(|known| known == section) {
            return Err(unknown(section, section, sections().map(str::to_owned)));
        }
        match value {
            Value::Table(keys) => refuse_unknown_in(section, section, keys)?,
            Value::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    if let Value::Table(keys) = item {
                        refuse_unknown_in(section, &format!("{section}[{index}]"), keys)?;
                    }
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn refuse_unknown_in(section: &str, path: &str, keys: &Table) -> Result<(), DesignError> {
    match keys.keys().find(|key| !all_keys().any(|known| known == format!("{section}.{key}"))) {
        None => Ok(()),
        Some(key) => {
            Err(unknown(&format!("{path}.{key}"), &format!("{section}.{key}"), all_keys()))
        }
    }
}

fn sections() -> impl Iterator<Item = &'static str> {
    KEYS.iter().filter_map(|(key, _)| key.split_once('.')).map(|(section, _)| section)
}

fn all_keys() -> impl Iterator<Item = String> {
    KEYS.iter().map(|(key, _)| (*key).to_owned())
}

/// The error for `shown`; the nearest key is looked for under the name `plain`.
fn unknown(shown: &str, plain: &str, candidates: impl Iterator<Item = String>) -> DesignError {
    /// Below this similarity a suggestion would only confuse.
    const SIMILAR: f64 = 0.6;
    let nearest = candidates
        .map(|key| (strsim::jaro_winkler(&key, plain).max(same_leaf(&key, plain)), key))
        .filter(|(similarity, _)| *similarity >= SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, key)| key);
    DesignError::UnknownKey { key: shown.to_owned(), nearest }
}

/// A key that stands in the wrong table is nearest to the key of that name.
fn same_leaf(a: &str, b: &str) -> f64 {
    let leaf = |key: &str| key.rsplit('.').next().map(str::to_owned);
    if leaf(a) == leaf(b) { 0.95 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `docs/configuration.md` has one row per key, and every value that a key takes by name stands in it.
    #[test]
    fn the_page_of_the_configuration_has_every_key() {
        let page = include_str!("../../../docs/configuration.md");
        let rows: Vec<(&str, &str)> = page
            .lines()
            .filter_map(|line| line.strip_prefix("| `")?.split_once("` |"))
            .filter(|(key, _)| key.contains('.'))
            .collect();
        for (key, _) in KEYS {
            let row = rows.iter().find(|(name, _)| name == key);
            let (_, row) =
                row.unwrap_or_else(|| panic!("{key} has no row in docs/configuration.md"));
            for value in takes(key).split('"').skip(1).step_by(2) {
                assert!(
                    row.contains(&format!("`\"{value}\"`")),
                    "the row of {key} lacks \"{value}\""
                );
            }
        }
        for (key, _) in &rows {
            assert!(KEYS.iter().any(|(known, _)| known == key), "{key} is no key");
        }
        assert_eq!(rows.len(), KEYS.len(), "a key has two rows");
    }
}
