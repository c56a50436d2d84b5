// SPDX-License-Identifier: MIT OR Apache-2.0
//! The keys of a configuration, to refuse unknown ones by name and with the nearest known one.

use crate::SpecError;
use toml::{Table, Value};

/// Every key, dotted; `spatial` is an array of tables.
const KEYS: &[&str] = &[
    "frame.width",
    "frame.height",
    "frame.pixel_bits",
    "region.size",
    "region.neighborhood",
    "denoise.filter",
    "spatial.feature",
    "spatial.level",
    "spatial.min_score",
    "spatial.mean_fraction_bits",
    "decision.combine",
    "temporal.level",
    "temporal.min_count",
    "temporal.reference",
    "render.irrelevant",
    "render.payload",
    "hardware.organization",
    "hardware.fold",
    "hardware.thresholds",
];

/// Refuses the first key of `table` that is not one of [`KEYS`].
pub(crate) fn refuse_unknown(table: &Table) -> Result<(), SpecError> {
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

fn refuse_unknown_in(section: &str, path: &str, keys: &Table) -> Result<(), SpecError> {
    match keys.keys().find(|key| !KEYS.contains(&format!("{section}.{key}").as_str())) {
        None => Ok(()),
        Some(key) => {
            Err(unknown(&format!("{path}.{key}"), &format!("{section}.{key}"), all_keys()))
        }
    }
}

fn sections() -> impl Iterator<Item = &'static str> {
    KEYS.iter().filter_map(|key| key.split_once('.')).map(|(section, _)| section)
}

fn all_keys() -> impl Iterator<Item = String> {
    KEYS.iter().map(|&key| key.to_owned())
}

/// The error for `shown`; the nearest key is looked for under the name `plain`.
fn unknown(shown: &str, plain: &str, candidates: impl Iterator<Item = String>) -> SpecError {
    /// Below this similarity a suggestion would only confuse.
    const SIMILAR: f64 = 0.6;
    let nearest = candidates
        .map(|key| (strsim::jaro_winkler(&key, plain).max(same_leaf(&key, plain)), key))
        .filter(|(similarity, _)| *similarity >= SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, key)| key);
    SpecError::UnknownKey { key: shown.to_owned(), nearest }
}

/// A key that stands in the wrong table is nearest to the key of that name.
fn same_leaf(a: &str, b: &str) -> f64 {
    let leaf = |key: &str| key.rsplit('.').next().map(str::to_owned);
    if leaf(a) == leaf(b) { 0.95 } else { 0.0 }
}
