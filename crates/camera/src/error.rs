// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of configurations. Every message names the key, the value and the valid values.

use thiserror::Error;

/// An error that keeps a configuration from becoming a camera or a design.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum ConfigError {
    /// The text is not TOML.
    #[error("the configuration is not valid TOML: {}", printable(.0))]
    Syntax(String),
    /// A key that does not exist.
    #[error("unknown key `{}`{}", printable(key), hint(nearest))]
    UnknownKey { key: String, nearest: Option<String> },
    /// A value of the wrong type, or a name that the key does not take.
    #[error("`{}`: {}", printable(key), printable(problem))]
    Type { key: String, problem: String },
    /// A value outside its range.
    #[error("`{key}` = {value} is out of range; the valid range is {valid}")]
    Range { key: String, value: String, valid: String },
    /// Keys that are valid alone but not together.
    #[error("`{key}` = {value} cannot be combined with {with}; {remedy}")]
    Combination { key: String, value: String, with: String, remedy: String },
    /// An override that is not `KEY=TOML_VALUE`.
    #[error("`--set {}`: {}", printable(text), printable(problem))]
    Override { text: String, problem: String },
    /// A preset that does not exist.
    #[error("unknown preset `{}`; presets are {known}", printable(name))]
    UnknownPreset { name: String, known: String },
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
