// SPDX-License-Identifier: MIT OR Apache-2.0
//! A text file of comma-separated lines, open.

use std::io::Write as _;
use std::path::Path;

use super::growing::GrowingFile;
use crate::SimulatorError;

/// The file.
pub(super) struct Csv(GrowingFile);

impl Csv {
    /// Creates the file with its first line.
    pub(super) fn create(path: &Path, heading: &str) -> Result<Self, SimulatorError> {
        let mut csv = Self(GrowingFile::create(path)?);
        csv.line([heading]);
        Ok(csv)
    }

    /// Appends a line of fields that need no quotes.
    pub(super) fn line(&mut self, fields: impl IntoIterator<Item = impl std::fmt::Display>) {
        let line = self.0.end();
        for (index, field) in fields.into_iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            // Memory takes everything.
            let _ = write!(line, "{comma}{field}");
        }
        line.push(b'\n');
    }

    pub(super) fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.0.write_out(all)
    }
}

/// A field of a CSV file (RFC 4180).
#[must_use]
pub fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// A name that every reader takes as it is, those too that know neither quotes nor that a `#` can be
/// part of a name: the characters `,` `#` `"` `%` and control characters as in a URL (`%2C`).
#[must_use]
pub fn plain(name: &str) -> String {
    use std::fmt::Write as _;
    let mut text = String::with_capacity(name.len());
    for letter in name.chars() {
        match letter {
            ',' | '#' | '"' | '%' | '\0'..='\x1F' | '\x7F' => {
                let _ = write!(text, "%{:02X}", u32::from(letter));
            }
            other => text.push(other),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_quoted_where_they_must_be() {
        assert_eq!(quoted("a b.png"), "a b.png");
        assert_eq!(quoted("a,\"b\".png"), "\"a,\"\"b\"\".png\"");
    }

    #[test]
    fn plain_names_need_no_quotes_and_can_be_taken_back() {
        assert_eq!(plain("clips/a b-1_\u{fc}.png"), "clips/a b-1_\u{fc}.png");
        assert_eq!(plain("a,\"b\"#1 50%\n.png"), "a%2C%22b%22%231 50%25%0A.png");
        assert_eq!(quoted(&plain("a,\"\r")), plain("a,\"\r"));
    }
}
