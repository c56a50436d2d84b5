// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of accelerators and layers.

/// An accelerator or a layer is invalid, or the layer cannot run on the accelerator.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum AcceleratorError {
    /// The text is not valid TOML.
    #[error("the accelerator is not valid TOML: {}", escaped_line(.0))]
    InvalidToml(String),
    /// A key is missing, is unknown, or has a value of the wrong type.
    #[error("accelerator, `{}`: {}", escaped_line(key), escaped_line(problem))]
    InvalidKey { key: String, problem: String },
    /// A value is outside its range.
    #[error("accelerator, `{key}` = {value} is out of range; the valid range is {valid}")]
    OutOfRange { key: &'static str, value: String, valid: &'static str },
    /// The preset does not exist.
    #[error("unknown accelerator `{}`; presets are {known}", escaped_line(name))]
    UnknownPreset { name: String, known: String },
    /// The shapes of a layer contradict each other.
    #[error("the layer's {what} is {value}, but must be {valid}")]
    InvalidLayer { what: &'static str, value: u128, valid: String },
    /// The buffer is too small for the layer.
    #[error(
        "`array.buffer_bytes` = {buffer} is too small for this layer; its smallest pass needs {needed} bytes"
    )]
    BufferTooSmall { buffer: u64, needed: u64 },
}

/// Escapes the control characters in a user's text, so that a message stays on one line and cannot
/// control the terminal.
fn escaped_line(text: &str) -> String {
    let shown = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.into() };
    text.trim_end().chars().map(shown).collect()
}
