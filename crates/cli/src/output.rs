// SPDX-License-Identifier: MIT OR Apache-2.0
//! Printing on standard output: text for people, JSON for machines.

use std::io::{self, Write};

use foveate_output::report::Report;
use serde::Serialize;
use terminal_size::Width;

use crate::error::CliError;
use crate::notice::printable;

/// Prints `text`. A closed pipe (`foveate ... | head`) is no error.
pub(crate) fn print_text(text: &str) -> Result<(), CliError> {
    write_text(&printable(text))
}

fn write_text(text: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(CliError::Usage(format!("cannot write to standard output: {e}")))
        }
        _ => Ok(()),
    }
}

/// Prints `value` as indented JSON.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), CliError> {
    let rendered = serde_json::to_string_pretty(value)
        .map_err(|e| CliError::Usage(format!("cannot write JSON: {e}")))?;
    // JSON has its own way to write control characters.
    write_text(&(rendered + "\n"))
}

/// Prints a result as JSON, as Markdown, or as tables for the terminal.
pub(crate) fn print_report(
    (is_json, is_markdown): (bool, bool),
    value: &impl Serialize,
    report: &Report,
) -> Result<(), CliError> {
    match (is_json, is_markdown) {
        (true, _) => print_json(value),
        (false, true) => print_text(&report.markdown()),
        (false, false) => print_text(&report.text(text_width())),
    }
}

/// Prints a result as JSON, or its text unless the command is quiet.
pub(crate) fn print_result(
    (is_json, is_quiet): (bool, bool),
    value: &impl Serialize,
    text: impl FnOnce() -> String,
) -> Result<(), CliError> {
    match (is_json, is_quiet) {
        (true, _) => print_json(value),
        (false, true) => Ok(()),
        (false, false) => print_text(&text()),
    }
}

/// Returns a paragraph of at most `width` columns; its later lines are indented.
pub(crate) fn paragraph(text: &str, width: usize) -> String {
    textwrap::fill(text, textwrap::Options::new(width).subsequent_indent("  ")) + "\n"
}

/// Returns the columns to fill, 40 to 120: the value of the environment variable `COLUMNS`, or else
/// the width of the terminal, or else 80.
pub(crate) fn text_width() -> usize {
    let from_environment = || std::env::var("COLUMNS").ok()?.parse().ok();
    let from_terminal =
        || terminal_size::terminal_size().map(|(Width(columns), _)| usize::from(columns));
    from_environment().or_else(from_terminal).unwrap_or(80).clamp(40, 120)
}
