// SPDX-License-Identifier: MIT OR Apache-2.0
//! Printing: text for people, JSON for machines, both on standard output.

use std::io::{self, Write};

use serde::Serialize;
use terminal_size::Width;

use crate::error::CliError;
use crate::notice::printable;

/// Prints `text`; a closed pipe (`foveate ... | head`) ends quietly.
pub(crate) fn text(text: &str) -> Result<(), CliError> {
    print(&printable(text))
}

fn print(text: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(CliError::Usage(format!("cannot write to standard output: {e}")))
        }
        _ => Ok(()),
    }
}

/// Prints `value` as indented JSON.
pub(crate) fn json(value: &impl Serialize) -> Result<(), CliError> {
    let rendered = serde_json::to_string_pretty(value)
        .map_err(|e| CliError::Usage(format!("cannot write JSON: {e}")))?;
    // JSON has its own way to write control characters.
    print(&(rendered + "\n"))
}

/// Columns to fill, within reason: what the environment variable `COLUMNS` says, or the terminal; 80
/// where there is neither.
pub(crate) fn width() -> usize {
    let from_environment = || std::env::var("COLUMNS").ok()?.parse().ok();
    let from_terminal =
        || terminal_size::terminal_size().map(|(Width(columns), _)| usize::from(columns));
    from_environment().or_else(from_terminal).unwrap_or(80).clamp(40, 120)
}
