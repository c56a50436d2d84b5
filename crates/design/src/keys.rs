// SPDX-License-Identifier: MIT OR Apache-2.0
//! The keys of a configuration, to refuse unknown ones by name and with the nearest known one.

use crate::DesignError;
use toml::{Table, Value};

/// Every key, dotted, and what it takes; `spatial` is an array of tables.
const KEYS: &[(&str, &str)] = &[
    ("frame.width", "a whole number, 1..=16384"),
    ("frame.height", "a whole number, 1..=16384"),
    ("frame.pixel_bits", "a whole number, 1..=16"),
    ("region.size", "a whole number, 2..=64"),
    ("region.neighborhood", "\"isolated\" or \"shared\""),
    ("denoise.filter", "\"none\" or \"median3x3\""),
    ("spatial.feature", "\"edge\", \"corner\", \"mad\" or \"variance\""),
    ("spatial.level", "a whole number >= 0, in grey levels"),
    ("spatial.min_score", "a number >= 0 with at most nine digits after the point"),
    ("spatial.mean_fraction_bits", "a whole number, 0..=12"),
    ("decision.combine", "\"any\" or \"all\""),
    ("temporal.level", "a whole number >= 0, in grey levels"),
    ("temporal.min_count", "a whole number >= 0, in pixels"),
    ("temporal.reference", "\"previous\" or \"last-sent\""),
    ("render.irrelevant", "\"zero\" or \"hold\""),
    ("render.payload", "\"denoised\" or \"raw\""),
    ("hardware.organization", "\"pipelined\" or \"serial\""),
    ("hardware.fold", "a whole number >= 1"),
    ("hardware.feed", "\"parallel\" or \"raster\""),
    ("hardware.thresholds", "\"runtime\" or \"constant\""),
];

/// What the key at `path`, such as `spatial[0].level`, takes.
pub(crate) fn takes(path: &str) -> &'static str {
    let dotted: String = path
        .split('[')
        .enumerate()
        .map(|(part, text)| match part {
            0 => text,
            _ => text.split_once(']').map_or("", |(_, rest)| rest),
        })
        .collect();
    let key = KEYS.iter().find(|(key, _)| *key == dotted);
    key.map_or_else(
        || if path == "spatial" { "an array of tables" } else { "a table" },
        |(_, takes)| takes,
    )
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
