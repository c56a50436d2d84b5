// SPDX-License-Identifier: MIT OR Apache-2.0
//! The keys of a configuration. An unknown key is refused by name, and the message suggests the
//! nearest known key.

use crate::choice::quoted_list;
use crate::{
    ConfigError, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, Payload,
    ReferencePolicy, RegionClass, VoteCombination,
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

/// A dotted key and the values that it accepts. An array of tables, such as `spatial`, is written
/// without an index.
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
    ("zones.off_level", Text("a whole number >= 0, in grey levels")),
    ("zones.map", Text("the path of an image")),
    ("zones.classes", Text("a list of strings with a digit 0..3 for each region or pixel")),
    ("zones.areas.class", Names(RegionClass::NAMES)),
    ("zones.areas.rectangle", Text("[left, top, width, height] in pixels")),
    ("zones.areas.polygon", Text("three or more corners [x, y] in pixels")),
    ("zones.keen.spatial.feature", Names(FeatureKind::NAMES)),
    ("zones.keen.spatial.level", Text("a whole number >= 0, in grey levels")),
    (
        "zones.keen.spatial.min_score",
        Text("a number >= 0 with at most nine digits after the point"),
    ),
    ("zones.keen.temporal.level", Text("a whole number >= 0, in grey levels")),
    ("zones.keen.temporal.min_count", Text("a whole number >= 0, in pixels")),
    ("zones.keen.periphery.level", Text("a whole number >= 0, in grey levels")),
];

/// The keys whose values are arrays of tables.
const ARRAYS_OF_TABLES: &[&str] = &["spatial", "zones.areas", "zones.keen.spatial"];

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
        None if ARRAYS_OF_TABLES.contains(&&dotted[..]) => "an array of tables".to_owned(),
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
        refuse_unknown_in(known, section, section, value)?;
    }
    Ok(())
}

/// Refuses the first unknown key in the value of a key, `plain` without indices and `shown` with
/// them. A value that is not a table of keys is checked by its type later.
fn refuse_unknown_in(
    known: &[&ConfigKey],
    plain: &str,
    shown: &str,
    value: &Value,
) -> Result<(), ConfigError> {
    match value {
        _ if known.iter().any(|(key, _)| *key == plain) => Ok(()),
        Value::Table(keys) => keys.iter().try_for_each(|(key, value)| {
            let (plain, shown) = (format!("{plain}.{key}"), format!("{shown}.{key}"));
            let is_part = |whole: &str| {
                whole
                    .strip_prefix(&plain)
                    .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
            };
            if known.iter().any(|(key, _)| is_part(key)) {
                return refuse_unknown_in(known, &plain, &shown, value);
            }
            let all = known.iter().map(|(key, _)| (*key).to_owned());
            Err(unknown_key_error(&shown, &plain, all))
        }),
        Value::Array(items) => items.iter().enumerate().try_for_each(|(index, item)| {
            refuse_unknown_in(known, plain, &format!("{shown}[{index}]"), item)
        }),
        _ => Ok(()),
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

/// Returns true for the dotted key of a list of tables, such as `zones.areas`.
pub(crate) fn is_array_of_tables(key: &str) -> bool {
    ARRAYS_OF_TABLES.contains(&key)
}

/// Returns a high similarity for keys of the same name in different tables, else 0.
fn leaf_similarity(a: &str, b: &str) -> f64 {
    let leaf = |key: &str| key.rsplit('.').next().map(str::to_owned);
    if leaf(a) == leaf(b) { 0.95 } else { 0.0 }
}
