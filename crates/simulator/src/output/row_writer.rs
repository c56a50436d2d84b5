// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of the file formats of the table of regions.

use super::csv::CsvFile;
use crate::SimulatorError;
use foveate_engine::{EventFrame, EventTable};
use std::path::PathBuf;

/// An open file of the table.
pub(super) trait RowWriter: Send {
    /// Appends the rows of a frame.
    fn rows(&mut self, table: &EventTable, frame: &EventFrame<'_>);
    /// Writes the buffered data, as [`super::sink::FrameSink::write_out`] does.
    fn write_out(&mut self) -> Result<(), SimulatorError>;
    /// Returns the path that can be given up, as [`super::sink::FrameSink::expendable_path`] does.
    fn expendable(&self) -> Option<PathBuf> {
        None
    }
    fn finish(self: Box<Self>) -> Result<(), SimulatorError>;
}

impl RowWriter for CsvFile {
    fn rows(&mut self, table: &EventTable, frame: &EventFrame<'_>) {
        table.csv(frame, self.buffer());
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.write_pending()
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        self.write_all()
    }
}
