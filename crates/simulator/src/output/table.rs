// SPDX-License-Identifier: MIT OR Apache-2.0
//! `frames.csv`: one line per frame, so that every row of the arrays has a name and a time.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::cannot_write;
use crate::SimulatorError;

/// What the table says of a frame.
pub(super) struct Row<'a> {
    pub(super) frame: u64,
    pub(super) time_us: u64,
    pub(super) name: &'a str,
    pub(super) label: Option<&'a str>,
    pub(super) srs: u64,
    pub(super) trs: u64,
    pub(super) active: u64,
    pub(super) pixels_forwarded: u64,
}

/// The file, open.
pub(super) struct FrameTable {
    path: PathBuf,
    file: BufWriter<File>,
}

impl FrameTable {
    pub(super) fn create(path: &Path) -> Result<Self, SimulatorError> {
        let file = File::create(path).map_err(cannot_write(path))?;
        let mut table = Self { path: path.to_owned(), file: BufWriter::new(file) };
        table.line(
            "frame,time_us,name,label,srs_regions,trs_regions,active_regions,pixels_forwarded",
        )?;
        Ok(table)
    }

    pub(super) fn push(&mut self, row: &Row<'_>) -> Result<(), SimulatorError> {
        let Row { frame, time_us, name, label, srs, trs, active, pixels_forwarded } = row;
        let (name, label) = (quoted(name), quoted(label.unwrap_or_default()));
        self.line(&format!(
            "{frame},{time_us},{name},{label},{srs},{trs},{active},{pixels_forwarded}"
        ))
    }

    pub(super) fn finish(mut self) -> Result<(), SimulatorError> {
        self.file.flush().map_err(cannot_write(&self.path))
    }

    fn line(&mut self, text: &str) -> Result<(), SimulatorError> {
        writeln!(self.file, "{text}").map_err(cannot_write(&self.path))
    }
}

/// A field of a CSV file (RFC 4180).
fn quoted(text: &str) -> String {
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
