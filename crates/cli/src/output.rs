// SPDX-License-Identifier: MIT OR Apache-2.0
//! Printing on standard output: text for people, JSON for machines.

use std::io::{self, Write};

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

/// Returns the columns to fill, 40 to 120: the value of the environment variable `COLUMNS`, or else
/// the width of the terminal, or else 80.
pub(crate) fn text_width() -> usize {
    let from_environment = || std::env::var("COLUMNS").ok()?.parse().ok();
    let from_terminal =
        || terminal_size::terminal_size().map(|(Width(columns), _)| usize::from(columns));
    from_environment().or_else(from_terminal).unwrap_or(80).clamp(40, 120)
}
