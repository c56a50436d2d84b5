// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of configurations. Every message names the key, the value and the valid values.

use thiserror::Error;

/// An error that keeps a configuration from becoming a camera or a design.
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
    /// A value of the wrong type, or a name that the key does not take.
    #[error("`{}`: {}", printable(key), printable(problem))]
    Type {
        /// Dotted path of the key.
        key: String,
        /// Description of the error, with the valid values.
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
        /// Dotted path of the first key.
        key: String,
        /// Value of the first key.
        value: String,
        /// The key or the property that the value cannot be combined with.
        with: String,
        /// Advice to the user.
        remedy: String,
    },
    /// An override that is not `KEY=TOML_VALUE`.
    #[error("`--set {}`: {}", printable(text), printable(problem))]
    Override {
        /// The override as the user wrote it.
        text: String,
        /// Description of the error in the override.
        problem: String,
    },
    /// A preset that does not exist.
    #[error("unknown preset `{}`; presets are {known}", printable(name))]
    UnknownPreset {
        /// The name as the user wrote it.
        name: String,
        /// The names of all presets.
        known: String,
    },
}

fn hint(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|key| format!("; did you mean `{key}`?")).unwrap_or_default()
}

/// Returns text of the user with control characters escaped, so that a message stays one line and
/// cannot steer the terminal.
fn printable(text: &str) -> String {
    let shown = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.into() };
    text.chars().map(shown).collect()
}
