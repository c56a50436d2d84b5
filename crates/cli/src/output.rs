// SPDX-License-Identifier: MIT OR Apache-2.0
//! Printing: text for people, JSON for machines, both on standard output.

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{self, Write};

use foveate_footage::redacted;
use serde::Serialize;
use terminal_size::Width;

use crate::error::CliError;

/// Prints `text`; a closed pipe (`foveate ... | head`) ends quietly.
pub(crate) fn text(text: &str) -> Result<(), CliError> {
    print(&printable(text))
}

/// Text in which no name of a file, no message of a tool and no data gives orders to a terminal: control characters are
/// written out, such as `\u{1b}`, but for tabs and ends of lines.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    let is_order = |letter: char| letter.is_control() && letter != '\n' && letter != '\t';
    if !text.contains(is_order) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        if is_order(letter) {
            shown.extend(letter.escape_default());
        } else {
            shown.push(letter);
        }
    }
    shown.into()
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

/// Says on standard error what the user should know. Nothing that is said has the secrets of an address, wherever it comes from,
/// and none of it moves the cursor of a terminal.
pub(crate) fn say(text: &(impl Display + ?Sized)) {
    // A terminal that was closed hears nothing, and that changes no exit code.
    let _ = writeln!(io::stderr(), "foveate: {}", printable(&redacted(&text.to_string())));
}

/// Says on standard error what the user should know although the command goes on.
pub(crate) fn warn(text: &str) {
    say(&format_args!("warning: {text}"));
}

/// Prints help, or what is wrong with the words of the command line.
pub(crate) fn usage(error: &clap::Error) {
    let plain = error.render().to_string();
    if error.use_stderr() && redacted(&plain) != plain {
        let _ = write!(io::stderr(), "{}", redacted(&plain));
        return;
    }
    // Help goes to standard output, which may be closed.
    let _ = error.print();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_gives_orders_to_a_terminal() {
        assert_eq!(printable("a\tb\n\u{e4}"), "a\tb\n\u{e4}");
        assert_eq!(printable("\u{1b}[2J\r\u{9b}"), "\\u{1b}[2J\\r\\u{9b}");
    }
}
