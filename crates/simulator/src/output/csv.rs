// SPDX-License-Identifier: MIT OR Apache-2.0
//! A text file of comma-separated lines, open.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use super::cannot_write;
use crate::SimulatorError;

/// The file and the line in the making.
pub(super) struct Csv {
    path: PathBuf,
    file: BufWriter<File>,
    line: String,
}

impl Csv {
    /// Creates the file with its first line.
    pub(super) fn create(path: &Path, heading: &str) -> Result<Self, SimulatorError> {
        let file = File::create(path).map_err(cannot_write(path))?;
        let file = BufWriter::new(file);
        let mut csv = Self { path: path.to_owned(), file, line: String::new() };
        csv.line([heading])?;
        Ok(csv)
    }

    /// Appends a line of fields that need no quotes.
    pub(super) fn line(
        &mut self,
        fields: impl IntoIterator<Item = impl std::fmt::Display>,
    ) -> Result<(), SimulatorError> {
        self.line.clear();
        for (index, field) in fields.into_iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            // A string takes everything.
            let _ = write!(self.line, "{comma}{field}");
        }
        self.line.push('\n');
        self.file.write_all(self.line.as_bytes()).map_err(cannot_write(&self.path))
    }

    pub(super) fn finish(mut self) -> Result<(), SimulatorError> {
        self.file.flush().map_err(cannot_write(&self.path))
    }
}

/// A field of a CSV file (RFC 4180).
pub(super) fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_quoted_where_they_must_be() {
        assert_eq!(quoted("a b.png"), "a b.png");
        assert_eq!(quoted("a,\"b\".png"), "\"a,\"\"b\"\".png\"");
    }
}
