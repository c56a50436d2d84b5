// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with an accelerator or a layer.

/// Why there is no such accelerator, no such layer, or no way to run the one on the other.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AcceleratorError {
    /// The text is not TOML.
    #[error("the accelerator is not valid TOML: {}", one_line(.0))]
    Syntax(String),
    /// A key that is missing, unknown, or has a value of the wrong type.
    #[error("accelerator, `{}`: {}", one_line(key), one_line(problem))]
    Key {
        /// Dotted path of the key, or of the table that holds it.
        key: String,
        /// What is wrong and what would be valid.
        problem: String,
    },
    /// A value outside its range.
    #[error("accelerator, `{key}` = {value} is out of range; the valid range is {valid}")]
    Range {
        /// Dotted path of the key.
        key: &'static str,
        /// The value.
        value: String,
        /// The valid range.
        valid: &'static str,
    },
    /// A preset that does not exist.
    #[error("unknown accelerator `{}`; presets are {known}", one_line(name))]
    UnknownPreset {
        /// The name as given.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// A layer whose shapes contradict each other.
    #[error("the layer's {what} is {value}, but must be {valid}")]
    Layer {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: u128,
        /// What would be valid.
        valid: String,
    },
    /// The buffer is too small for the layer.
    #[error(
        "`array.buffer_bytes` = {buffer} is too small for this layer; its smallest pass needs {needed} bytes"
    )]
    Room {
        /// Bytes of the buffer.
        buffer: u64,
        /// Bytes of the smallest pass.
        needed: u64,
    },
}

/// What a user wrote, with control characters made visible: a message stays one line and cannot steer the terminal.
fn one_line(text: &str) -> String {
    let shown = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.into() };
    text.trim_end().chars().map(shown).collect()
}
