// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the table of regions asks of a file format.

use std::path::PathBuf;

use foveate_engine::{EventTable, Moment};

use super::csv::Csv;
use crate::SimulatorError;

/// A file of the table, open.
pub(super) trait RowWriter: Send {
    /// Appends the rows of a frame.
    fn rows(&mut self, table: &EventTable, moment: &Moment<'_>);
    /// As [`super::sink::Sink::write_out`].
    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError>;
    /// As [`super::sink::Sink::expendable`].
    fn expendable(&self) -> Option<PathBuf> {
        None
    }
    fn finish(self: Box<Self>) -> Result<(), SimulatorError>;
}

impl RowWriter for Csv {
    fn rows(&mut self, table: &EventTable, moment: &Moment<'_>) {
        table.csv(moment, self.end());
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        Csv::write_out(self, all)
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        Csv::write_out(&mut self, true)
    }
}
