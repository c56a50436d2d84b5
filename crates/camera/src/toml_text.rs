// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reading and writing of configurations as TOML text, with `KEY=VALUE` overrides. A configuration
//! may have more tables than those of a camera.

use crate::depth::DEFAULT_BITS;
use crate::{CAMERA_KEYS, CameraConfig, ConfigError, ConfigKey, IrrelevantRendering, keys};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_path_to_error::{Path, Segment};
use toml::{Table, Value};

/// A configuration that is stored as TOML: the tables of a camera, and possibly more.
pub trait TomlConfig: Serialize + Sized {
    /// Returns the keys of the configuration.
    fn keys() -> impl Iterator<Item = &'static ConfigKey>;

    /// Reads the configuration from a table that has no unknown key.
    ///
    /// # Errors
    /// Returns an error if a value is of the wrong type. [`read_table`] names the key.
    fn from_table(table: Table) -> Result<Self, ConfigError>;
}

/// Reads a configuration and applies `overrides`, by the rules of [`CameraConfig::from_toml_with`].
///
/// # Errors
/// Returns the errors of [`CameraConfig::from_toml_with`].
pub fn read<C: TomlConfig, S: AsRef<str>>(text: &str, overrides: &[S]) -> Result<C, ConfigError> {
    let mut written: Table =
        text.parse().map_err(|e: toml::de::Error| ConfigError::Syntax(syntax_message(&e)))?;
    let table = with_overrides(&written, overrides)?;
    let hides_means = shows_means(&written) && !shows_means(&table);
    let depth = written_depth(&table)
        .filter(|&bits| written_depth(&written).is_some_and(|own| own != bits));
    if !hides_means && depth.is_none() {
        return from_checked_table(table);
    }
    // The text is changed by what the overrides imply, and overridden again.
    keys::refuse_unknown(&C::keys().collect::<Vec<_>>(), &written)?;
    if hides_means {
        remove_levels_of_means(&mut written);
    }
    if let Some(bits) = depth {
        written = scaled_table(written, bits)?;
    }
    from_checked_table(with_overrides(&written, overrides)?)
}

/// Returns the text of a configuration as a TOML file.
pub fn write<C: TomlConfig>(config: &C) -> String {
    toml::to_string(config).expect("TOML has a form for every value of a configuration")
}

impl CameraConfig {
    /// Reads a configuration. Keys that are left out have their defaults.
    ///
    /// # Errors
    /// Returns an error if the text is not TOML, has an unknown key, or a value of the wrong type.
    /// [`CameraConfig::validate`] checks ranges.
    pub fn from_toml(text: &str) -> Result<Self, ConfigError> {
        Self::from_toml_with(text, &[] as &[&str])
    }

    /// Reads a configuration and applies `overrides` in order. An override is
    /// `dotted.key=TOML_VALUE`, with an index for the array of features: `region.size=16`,
    /// `spatial.0.level=50`. A value that is not TOML is taken as a string, so that quotes can be
    /// left out.
    ///
    /// Thresholds in grey levels belong to the depth that they are written with: an override of
    /// `frame.pixel_bits` scales the thresholds of the text. Thresholds in other overrides are not
    /// scaled. An override of `render.irrelevant` with another value than `"mean"` removes the
    /// table `periphery` of the text and the levels of means in `zones`, which have a meaning only
    /// with means.
    ///
    /// # Errors
    /// Returns the errors of [`CameraConfig::from_toml`], and an error for an override that is not
    /// of that form.
    pub fn from_toml_with<S: AsRef<str>>(text: &str, overrides: &[S]) -> Result<Self, ConfigError> {
        read(text, overrides)
    }

    /// Returns the text of the configuration as a TOML file.
    #[must_use]
    pub fn to_toml(&self) -> String {
        write(self)
    }
}

/// Removes the keys that have a meaning only with means.
fn remove_levels_of_means(written: &mut Table) {
    written.remove("periphery");
    if let Some(Value::Table(zones)) = written.get_mut("zones") {
        zones.remove("off_level");
        if let Some(Value::Table(keen)) = zones.get_mut("keen") {
            keen.remove("periphery");
        }
    }
}

/// Returns the table of a configuration with the tables of its camera scaled to `bits` bits per
/// pixel, by the rules of [`CameraConfig::scaled_to_depth`].
fn scaled_table(table: Table, bits: u32) -> Result<Table, ConfigError> {
    let (camera, mut scaled): (Table, Table) =
        table.into_iter().partition(|(section, _)| keys::is_camera_section(section));
    let camera = CameraConfig::from_table(camera)?.scaled_to_depth(bits);
    scaled.extend(Table::try_from(camera).map_err(|e| ConfigError::Syntax(e.to_string()))?);
    Ok(scaled)
}

/// Refuses unknown keys of a table, and reads the configuration from it.
fn from_checked_table<C: TomlConfig>(table: Table) -> Result<C, ConfigError> {
    keys::refuse_unknown(&C::keys().collect::<Vec<_>>(), &table)?;
    C::from_table(table)
}

/// Reads a table by serde. The message of an error names the values that the key accepts, from
/// `keys`.
///
/// # Errors
/// Returns [`ConfigError::Type`] with the dotted path of the key.
pub fn read_table<T: DeserializeOwned>(
    keys: impl Iterator<Item = &'static ConfigKey>,
    table: Table,
) -> Result<T, ConfigError> {
    let value = Value::Table(table);
    serde_path_to_error::deserialize(value.clone()).map_err(|e| {
        let key = e.path().to_string();
        let accepted = || keys::accepted_values(keys, &key);
        let problem =
            describe_problem(value_at_path(&value, e.path()), e.inner().message(), accepted);
        ConfigError::Type { key, problem }
    })
}

impl TomlConfig for CameraConfig {
    fn keys() -> impl Iterator<Item = &'static ConfigKey> {
        CAMERA_KEYS.iter()
    }

    fn from_table(table: Table) -> Result<Self, ConfigError> {
        read_table(Self::keys(), table)
    }
}

/// Describes the error in the value of a key. The wording of serde is replaced.
fn describe_problem(
    value: Option<&Value>,
    message: &str,
    accepted: impl FnOnce() -> String,
) -> String {
    match value {
        _ if message.starts_with("missing field") => message.replace("missing field", "it lacks"),
        Some(value) => format!("{} is not valid; it takes {}", truncated_text(value), accepted()),
        None => message.to_owned(),
    }
}

/// Returns the value as TOML, cut off after 40 characters.
fn truncated_text(value: &Value) -> String {
    const LONGEST: usize = 40;
    let text = value.to_string();
    if text.chars().count() <= LONGEST {
        return text;
    }
    text.chars().take(LONGEST).chain("...".chars()).collect()
}

fn value_at_path<'a>(value: &'a Value, path: &Path) -> Option<&'a Value> {
    path.iter().try_fold(value, |here, step| match step {
        Segment::Map { key } => here.get(key),
        Segment::Seq { index } => here.get(*index),
        _ => None,
    })
}

/// Returns the message of a syntax error with its line and column, without the excerpt of the
/// source.
fn syntax_message(error: &toml::de::Error) -> String {
    let drawn = error.to_string();
    let place = drawn.lines().next().unwrap_or_default().replace("TOML parse error ", "");
    format!("{} ({place})", error.message().replace('\n', "; "))
}

/// Returns the bits per pixel of a table that has not been checked yet, or `None` if the value is
/// not a valid depth.
fn written_depth(table: &Table) -> Option<u32> {
    let bits = table.get("frame").and_then(|frame| frame.get("pixel_bits"));
    let bits = bits.map_or(Some(DEFAULT_BITS.into()), Value::as_integer)?;
    u32::try_from(bits).ok().filter(|bits| (1..=16).contains(bits))
}

/// Returns true if a table that has not been checked yet says that irrelevant regions send means.
fn shows_means(table: &Table) -> bool {
    let shown = table.get("render").and_then(|render| render.get("irrelevant"));
    shown.and_then(Value::as_str) == Some(IrrelevantRendering::Mean.name())
}

/// Returns a table with the overrides applied in order.
fn with_overrides<S: AsRef<str>>(table: &Table, overrides: &[S]) -> Result<Table, ConfigError> {
    let mut table = table.clone();
    overrides.iter().try_for_each(|text| apply_override(&mut table, text.as_ref()))?;
    Ok(table)
}

fn apply_override(table: &mut Table, text: &str) -> Result<(), ConfigError> {
    let problem = |problem: String| ConfigError::Override { text: text.to_owned(), problem };
    let (path, value) = text
        .split_once('=')
        .ok_or_else(|| problem("expected KEY=VALUE, for example region.size=16".to_owned()))?;
    let steps: Vec<&str> = path.trim().split('.').collect();
    if steps.iter().any(|step| step.is_empty()) {
        return Err(problem(format!("`{path}` is not a dotted key")));
    }
    *override_target(table, &steps).map_err(problem)? = parse_override_value(value.trim());
    Ok(())
}

/// Follows a dotted path, makes the tables that are missing, and returns the value that an override
/// replaces.
fn override_target<'a>(table: &'a mut Table, steps: &[&str]) -> Result<&'a mut Value, String> {
    let (first, rest) = steps.split_first().ok_or("the key is empty")?;
    let mut here = table.entry(*first).or_insert_with(|| match (*first, rest.is_empty()) {
        // In a file without features, `spatial.0.level` refers to the default feature.
        ("spatial", false) => default_features(),
        _ => Value::Table(Table::new()),
    });
    for (depth, step) in rest.iter().enumerate() {
        let above = steps[..=depth].join(".");
        if matches!(here, Value::Table(inner) if inner.is_empty())
            && keys::is_array_of_tables(&above)
        {
            return Err(format!(
                "`{above}` has no entries yet; give the whole list, {above}=[{{..}}]"
            ));
        }
        here = match here {
            Value::Table(inner) => inner.entry(*step).or_insert_with(|| Value::Table(Table::new())),
            Value::Array(items) => {
                let count = items.len();
                let index = step.parse::<usize>().ok();
                index.and_then(|index| items.get_mut(index)).ok_or_else(|| {
                    format!(
                        "`{step}` is not an index into `{above}`, which has {count} entries, \
                         numbered from 0"
                    )
                })?
            }
            _ => return Err(format!("`{step}` is inside a value that is not a table")),
        };
    }
    Ok(here)
}

fn default_features() -> Value {
    let features = Value::try_from(&CameraConfig::default().spatial);
    features.expect("TOML has a form for every value of a configuration")
}

fn parse_override_value(text: &str) -> Value {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct OverrideValue {
        value: Value,
    }
    toml::from_str::<OverrideValue>(&format!("value = {text}"))
        .map_or_else(|_| Value::String(text.to_owned()), |wrapped| wrapped.value)
}
