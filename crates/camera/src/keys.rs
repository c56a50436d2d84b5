// SPDX-License-Identifier: MIT OR Apache-2.0
//! The keys of a configuration. An unknown key is refused by name, and the message suggests the
//! nearest known key.

use crate::choice::quoted_list;
use crate::{
    ConfigError, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, Payload,
    ReferencePolicy, VoteCombination,
};
use crate::{FLOW_RADII, MAX_SIDE, MEAN_FRACTION_BITS, PIXEL_BITS, REGION_SIZES};
use AcceptedValues::{Names, Text, Whole};
use std::{fmt, ops::RangeInclusive};
use toml::{Table, Value};

/// The values that a key accepts, for messages and documentation.
#[derive(Clone, Debug)]
pub enum AcceptedValues {
    /// A whole number in this range.
    Whole(RangeInclusive<u32>),
    /// Values that are described by this text.
    Text(&'static str),
    /// One of these names.
    Names(&'static [&'static str]),
}

impl fmt::Display for AcceptedValues {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Whole(range) => write!(f, "a whole number, {}..={}", range.start(), range.end()),
            Text(text) => f.write_str(text),
            Names(names) => f.write_str(&quoted_list(names)),
        }
    }
}

/// A dotted key and the values that it accepts. The array of tables `spatial` is written without an
/// index.
pub type ConfigKey = (&'static str, AcceptedValues);

/// Every key of a camera.
pub const CAMERA_KEYS: &[ConfigKey] = &[
    ("frame.width", Whole(1..=MAX_SIDE)),
    ("frame.height", Whole(1..=MAX_SIDE)),
    ("frame.pixel_bits", Whole(PIXEL_BITS)),
    ("region.size", Whole(REGION_SIZES)),
    ("region.neighborhood", Names(Neighborhood::NAMES)),
    ("denoise.filter", Names(DenoiseFilter::NAMES)),
    ("spatial.feature", Names(FeatureKind::NAMES)),
    ("spatial.level", Text("a whole number >= 0, in grey levels")),
    ("spatial.min_score", Text("a number >= 0 with at most nine digits after the point")),
    ("spatial.mean_fraction_bits", Whole(MEAN_FRACTION_BITS)),
    ("spatial.radius", Whole(FLOW_RADII)),
    ("decision.combine", Names(VoteCombination::NAMES)),
    ("temporal.level", Text("a whole number >= 0, in grey levels")),
    ("temporal.min_count", Text("a whole number >= 0, in pixels")),
    ("temporal.reference", Names(ReferencePolicy::NAMES)),
    ("render.irrelevant", Names(IrrelevantRendering::NAMES)),
    ("render.payload", Names(Payload::NAMES)),
    ("periphery.blocks", Text("1, 2 or 4, and a divisor of region.size")),
    ("periphery.level", Text("a whole number >= 0, in grey levels")),
];

/// Returns a description of the values that the key at `path` accepts. A path has indices, such as
/// `spatial[0].level`.
pub(crate) fn accepted_values(
    mut known: impl Iterator<Item = &'static ConfigKey>,
    path: &str,
) -> String {
    let dotted: String = path
        .split('[')
        .enumerate()
        .map(|(part, text)| match part {
            0 => text,
            _ => text.split_once(']').map_or("", |(_, rest)| rest),
        })
        .collect();
    match known.find(|(key, _)| *key == dotted) {
        Some((_, values)) => values.to_string(),
        None if path == "spatial" => "an array of tables".to_owned(),
        None => "a table".to_owned(),
    }
}

/// Refuses the first key of `table` that is not in `known`.
pub(crate) fn refuse_unknown(known: &[&ConfigKey], table: &Table) -> Result<(), ConfigError> {
    for (section, value) in table {
        if !section_names(known).any(|one| one == section) {
            return Err(unknown_key_error(
                section,
                section,
                section_names(known).map(str::to_owned),
            ));
        }
        match value {
            Value::Table(keys) => refuse_unknown_in(known, section, section, keys)?,
            Value::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    if let Value::Table(keys) = item {
                        let path = format!("{section}[{index}]");
                        refuse_unknown_in(known, section, &path, keys)?;
                    }
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn refuse_unknown_in(
    known: &[&ConfigKey],
    section: &str,
    path: &str,
    keys: &Table,
) -> Result<(), ConfigError> {
    let is_known = |key: &&String| known.iter().any(|(one, _)| *one == format!("{section}.{key}"));
    match keys.keys().find(|key| !is_known(key)) {
        None => Ok(()),
        Some(key) => {
            let all = known.iter().map(|(key, _)| (*key).to_owned());
            Err(unknown_key_error(&format!("{path}.{key}"), &format!("{section}.{key}"), all))
        }
    }
}

/// Returns true if a table of this name is a part of a camera.
pub(crate) fn is_camera_section(name: &str) -> bool {
    section_names(&CAMERA_KEYS.iter().collect::<Vec<_>>()).any(|section| section == name)
}

fn section_names(known: &[&ConfigKey]) -> impl Iterator<Item = &'static str> {
    known.iter().filter_map(|(key, _)| key.split_once('.')).map(|(section, _)| section)
}

/// Returns the error for the key `shown`. The suggestion is the candidate that is most similar to
/// `plain`, the key without indices.
fn unknown_key_error(
    shown: &str,
    plain: &str,
    candidates: impl Iterator<Item = String>,
) -> ConfigError {
    /// A candidate below this similarity would only confuse.
    const SIMILAR: f64 = 0.6;
    let nearest = candidates
        .map(|key| (strsim::jaro_winkler(&key, plain).max(leaf_similarity(&key, plain)), key))
        .filter(|(similarity, _)| *similarity >= SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, key)| key);
    ConfigError::UnknownKey { key: shown.to_owned(), nearest }
}

/// Returns a high similarity for keys of the same name in different tables, else 0.
fn leaf_similarity(a: &str, b: &str) -> f64 {
    let leaf = |key: &str| key.rsplit('.').next().map(str::to_owned);
    if leaf(a) == leaf(b) { 0.95 } else { 0.0 }
}
