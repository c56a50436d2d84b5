// SPDX-License-Identifier: MIT OR Apache-2.0
//! Notices on standard error, errors and warnings, as text that is safe on a terminal.

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{self, Write};

use foveate_media::text_without_secrets;

/// Returns text that cannot control a terminal, even if it contains the name of a file, the message
/// of a tool or data. Control characters are written out, such as `\u{1b}`, except tabs and ends of
/// lines.
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

/// Prints a notice on standard error. It never shows the secrets of an address or controls the
/// terminal, whatever the origin of its text.
pub(crate) fn print_notice(text: &(impl Display + ?Sized)) {
    // A notice to a terminal that was closed is lost, and that changes no exit code.
    let _ =
        writeln!(io::stderr(), "foveate: {}", printable(&text_without_secrets(&text.to_string())));
}

/// Prints a warning on standard error. The command goes on.
pub(crate) fn print_warning(text: &str) {
    print_notice(&format_args!("warning: {text}"));
}

/// Prints help, or the error in the words of the command line.
pub(crate) fn print_usage(error: &clap::Error) {
    let plain = error.render().to_string();
    if error.use_stderr() && text_without_secrets(&plain) != plain {
        let _ = write!(io::stderr(), "{}", text_without_secrets(&plain));
        return;
    }
    // Help goes to standard output, which may be closed.
    let _ = error.print();
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
