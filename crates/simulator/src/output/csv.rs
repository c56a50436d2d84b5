// SPDX-License-Identifier: MIT OR Apache-2.0
//! A growing file of comma-separated lines.

use std::io::Write as _;
use std::path::Path;

use crate::SimulatorError;
use foveate_tools::GrowingFile;

/// The open file.
pub(crate) struct CsvFile(GrowingFile);

impl CsvFile {
    /// Creates the file with its first line.
    pub(crate) fn create(path: &Path, heading: &str) -> Result<Self, SimulatorError> {
        let mut csv = Self(GrowingFile::create(path)?);
        csv.line([heading]);
        Ok(csv)
    }

    /// Appends a line of fields that need no quotes.
    pub(crate) fn line(&mut self, fields: impl IntoIterator<Item = impl std::fmt::Display>) {
        let line = self.0.pending_mut();
        for (index, field) in fields.into_iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            // A write into memory cannot fail.
            let _ = write!(line, "{comma}{field}");
        }
        line.push(b'\n');
    }

    /// Returns the buffer to which whole lines are appended.
    pub(super) fn buffer(&mut self) -> &mut Vec<u8> {
        self.0.pending_mut()
    }

    /// Appends a line of fields that may need quotes.
    pub(super) fn quoted_line<const N: usize>(&mut self, fields: [&str; N]) {
        self.0.append(foveate_output::tables::csv_text([fields]).as_bytes());
    }

    pub(crate) fn write_pending(&mut self) -> Result<(), SimulatorError> {
        Ok(self.0.write_pending()?)
    }

    pub(crate) fn write_all(&mut self) -> Result<(), SimulatorError> {
        Ok(self.0.write_all()?)
    }
}
