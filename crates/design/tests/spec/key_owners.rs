// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of keys that belong to one organization, to some features or to one rendering of
//! irrelevant regions, as `docs/configuration.md` states. All others refuse such a key, whatever
//! its value. A key without an owner is accepted by all organizations.

use std::collections::BTreeMap;

use foveate_camera::{AcceptedValues, FeatureKind, IrrelevantRendering, toml_text::TomlConfig};
use foveate_design::{DesignConfig, Organization};

const PAGE: &str = include_str!("../../../../docs/configuration.md");

/// A row of a table of keys on the page.
struct KeyRow<'a> {
    key: &'a str,
    values: &'a str,
    meaning: &'a str,
    /// The text between the heading and the table.
    section: &'a str,
}

fn rows() -> Vec<KeyRow<'static>> {
    let sections = PAGE.split("\n## ").skip(1);
    let rows = sections.flat_map(|section| {
        let (before, table) = section.split_once("\n| key |").unwrap_or((section, ""));
        table.lines().filter_map(move |line| {
            let mut cells = line.strip_prefix("| ")?.split(" | ");
            let (key, values, meaning) = (cells.next()?, cells.next()?, cells.next()?);
            let key = key.strip_prefix('`')?.strip_suffix('`')?;
            Some(KeyRow { key, values, meaning, section: before })
        })
    });
    rows.filter(|row| row.key.contains('.')).collect()
}

/// Returns the values of the key of a row as TOML, the default first: the names that the key takes,
/// or the numbers and truth values in the row.
fn values(row: &KeyRow<'_>) -> Vec<String> {
    let takes = DesignConfig::keys().find(|(key, _)| *key == row.key).unwrap();
    if let AcceptedValues::Names(names) = takes.1 {
        return names.iter().map(|name| format!("\"{name}\"")).collect();
    }
    let words = row.values.split(|c: char| !c.is_ascii_alphanumeric());
    let is_value = |word: &&str| *word == "true" || *word == "false" || word.parse::<u32>().is_ok();
    words.filter(is_value).map(str::to_owned).collect()
}

/// Returns the owners of a key: the only settings with which it is accepted. The list is empty if
/// all settings accept it.
fn owners(row: &KeyRow<'_>) -> Vec<String> {
    if let Some(names) =
        row.meaning.strip_prefix("Only for ").and_then(|rest| rest.split(':').next())
    {
        let setting = |name: &str| {
            let name = name.trim_matches('`');
            let key = if Organization::NAMES.contains(&name) {
                "hardware.organization"
            } else if FeatureKind::NAMES.contains(&name) {
                "spatial.0.feature"
            } else {
                panic!("{}: `{name}` is neither an organization nor a feature", row.key)
            };
            format!("{key}=\"{name}\"")
        };
        return names.split(" and ").map(setting).collect();
    }
    let with = row.section.split_once("These keys apply only with `").map(|(_, rest)| rest);
    let setting = with.and_then(|rest| rest.split('`').next());
    setting.map(|setting| setting.replace(' ', "")).into_iter().collect()
}

fn all_settings(owner: &str) -> Vec<String> {
    let (key, _) = owner.split_once('=').unwrap();
    let names = match key {
        "hardware.organization" => Organization::NAMES,
        "spatial.0.feature" => FeatureKind::NAMES,
        "render.irrelevant" => IrrelevantRendering::NAMES,
        _ => panic!("{key} owns no key"),
    };
    names.iter().map(|name| format!("{key}=\"{name}\"")).collect()
}

/// Validates a small design with these keys.
fn validate_with(keys: &[&str]) -> Result<(), String> {
    let base = "[frame]\nwidth = 64\nheight = 64\n[[spatial]]\nfeature = \"edge\"\n";
    // Only `serial` has `flow`.
    let has_flow = keys.iter().any(|key| key.ends_with("\"flow\""));
    let organization = has_flow.then_some("hardware.organization=\"serial\"");
    let keys: Vec<&str> = keys.iter().copied().chain(organization).collect();
    let config = DesignConfig::from_toml_with(base, &keys).map_err(|error| error.to_string())?;
    config.validate().map(|_| ()).map_err(|error| error.to_string())
}

#[test]
fn a_key_of_one_is_refused_by_all_others_whatever_its_value() {
    let mut owned = BTreeMap::new();
    for row in rows() {
        let owners = owners(&row);
        let Some(owner) = owners.first() else { continue };
        let key = row.key.replace("spatial.", "spatial.0.");
        let mut taken = 0;
        for value in values(&row) {
            let setting = format!("{key}={value}");
            for other in all_settings(owner) {
                let said = validate_with(&[&other, &setting]);
                if owners.contains(&other) {
                    taken += usize::from(said.is_ok());
                    continue;
                }
                let error = said.expect_err(&format!("{other} takes {setting}"));
                let named = row.key.replace("spatial.", "spatial[0].");
                assert!(error.contains(&format!("`{named}` = {value}")), "{error}");
                assert!(error.contains("leave the key out"), "{error}");
            }
        }
        assert!(taken > 0, "{owners:?} take no value of {key}");
        *owned.entry(owners.join(", ")).or_insert(0) += 1;
    }
    let owned: Vec<_> = owned.iter().map(|(owner, keys)| (owner.as_str(), *keys)).collect();
    assert_eq!(
        owned,
        [
            ("hardware.organization=\"raster\"", 4),
            ("hardware.organization=\"serial\"", 2),
            ("render.irrelevant=\"mean\"", 2),
            ("spatial.0.feature=\"flow\"", 1),
            ("spatial.0.feature=\"mad\", spatial.0.feature=\"segment\"", 1),
        ]
    );
}

#[test]
fn a_key_of_an_organization_is_refused_with_one_message() {
    for row in rows() {
        let owners = owners(&row);
        let Some(owner) = owners.first() else { continue };
        let Some(name) = owner.strip_prefix("hardware.organization=") else { continue };
        let (name, value) = (name.trim_matches('"'), values(&row).remove(0));
        for other in Organization::NAMES.iter().filter(|&&other| other != name) {
            let keys =
                [format!("hardware.organization=\"{other}\""), format!("{}={value}", row.key)];
            assert_eq!(
                validate_with(&[&keys[0], &keys[1]]).unwrap_err(),
                format!(
                    "`{}` = {value} cannot be combined with organization = \"{other}\"; only the {name} organization has \
                     this key; leave the key out, or use organization = \"{name}\"",
                    row.key
                )
            );
        }
    }
}

#[test]
fn a_key_of_all_is_taken_by_all_with_its_default() {
    let mut checked = 0;
    // The keys of zones are those of tables in lists, or need other keys.
    let is_of_all = |row: &KeyRow| owners(row).is_empty() && !row.key.starts_with("zones.");
    for row in rows().iter().filter(|row| is_of_all(row)) {
        // The default of a threshold of a feature depends on the feature.
        let features = ["spatial.feature", "spatial.level", "spatial.min_score"];
        let Some(value) = values(row).into_iter().next() else { continue };
        if features.contains(&row.key) || row.key == "hardware.organization" {
            continue;
        }
        for organization in Organization::NAMES {
            let organization = format!("hardware.organization=\"{organization}\"");
            assert_eq!(
                validate_with(&[&organization, &format!("{}={value}", row.key)]),
                Ok(()),
                "{}",
                row.key
            );
        }
        checked += 1;
    }
    assert!(checked > 12, "{checked}");
}

#[test]
fn every_organization_has_zones() {
    for organization in Organization::NAMES {
        let organization = format!("hardware.organization=\"{organization}\"");
        assert_eq!(validate_with(&[&organization, "zones={}"]), Ok(()));
    }
}

#[test]
fn a_threshold_of_pixels_is_refused_where_pixels_have_none() {
    for feature in FeatureKind::NAMES {
        let feature = format!("spatial=[{{feature=\"{feature}\",level=3}}]");
        let is_taken = ["edge", "corner", "segment"].iter().any(|name| feature.contains(name));
        assert_eq!(validate_with(&[&feature]).is_ok(), is_taken, "{feature}");
    }
}
