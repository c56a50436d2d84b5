// SPDX-License-Identifier: MIT OR Apache-2.0
//! Printing: text for people, JSON for machines, both on standard output.

use std::io::{self, Write};

use serde::Serialize;

use crate::error::CliError;

/// Prints `text`; a closed pipe (`foveate ... | head`) ends quietly.
pub(crate) fn text(text: &str) -> Result<(), CliError> {
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
    text(&(rendered + "\n"))
}

/// Columns to fill: those of the terminal within reason, 80 where there is none.
pub(crate) fn width() -> usize {
    terminal_size::terminal_size()
        .map_or(80, |(terminal_size::Width(columns), _)| usize::from(columns).clamp(40, 120))
}
