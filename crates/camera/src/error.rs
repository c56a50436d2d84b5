// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with a configuration. Every message names the key, the value and what would
//! be valid.

use thiserror::Error;

/// A configuration that is no camera or no design.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConfigError {
    /// The text is not TOML.
    #[error("the configuration is not valid TOML: {}", printable(.0))]
    Syntax(String),
    /// A key that does not exist.
    #[error("unknown key `{}`{}", printable(key), hint(nearest))]
    UnknownKey {
        /// Dotted path of the key.
        key: String,
        /// The nearest key that exists.
        nearest: Option<String>,
    },
    /// A value of the wrong type or not one of the names that the key takes.
    #[error("`{}`: {}", printable(key), printable(problem))]
    Type {
        /// Dotted path of the key.
        key: String,
        /// What is wrong and what would be valid.
        problem: String,
    },
    /// A value outside its range.
    #[error("`{key}` = {value} is out of range; the valid range is {valid}")]
    Range {
        /// Dotted path of the key.
        key: String,
        /// The value.
        value: String,
        /// The valid range.
        valid: String,
    },
    /// Keys that are valid alone but not together.
    #[error("`{key}` = {value} cannot be combined with {with}; {remedy}")]
    Combination {
        /// Dotted path of the key.
        key: String,
        /// Its value.
        value: String,
        /// What it clashes with.
        with: String,
        /// What to do.
        remedy: String,
    },
    /// An override that is not `KEY=TOML_VALUE`.
    #[error("`--set {}`: {}", printable(text), printable(problem))]
    Override {
        /// The override as given.
        text: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A preset that does not exist.
    #[error("unknown preset `{}`; presets are {known}", printable(name))]
    UnknownPreset {
        /// The name as given.
        name: String,
        /// The names that exist.
        known: String,
    },
}

fn hint(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|key| format!("; did you mean `{key}`?")).unwrap_or_default()
}

/// What a user wrote, with control characters made visible: a message stays one line and cannot steer
/// the terminal.
fn printable(text: &str) -> String {
    let shown = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.into() };
    text.chars().map(shown).collect()
}
