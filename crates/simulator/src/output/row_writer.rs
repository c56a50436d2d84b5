// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the table of regions asks of a file format.

use std::path::PathBuf;

use foveate_files::tables::Value;

use super::csv::Csv;
use crate::SimulatorError;

/// A file of the table, open.
pub(super) trait RowWriter: Send {
    fn row(&mut self, values: &mut dyn Iterator<Item = Value<'static>>);
    /// As [`super::sink::Sink::write_out`].
    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError>;
    /// As [`super::sink::Sink::expendable`].
    fn expendable(&self) -> Option<PathBuf> {
        None
    }
    fn finish(self: Box<Self>) -> Result<(), SimulatorError>;
}

impl RowWriter for Csv {
    fn row(&mut self, values: &mut dyn Iterator<Item = Value<'static>>) {
        // A flag is a bit, so that tools which know numbers only can read all but the action.
        self.line(values.map(|value| match value {
            Value::Flag(flag) => Value::Int(flag.into()),
            other => other,
        }));
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        Csv::write_out(self, all)
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        Csv::write_out(&mut self, true)
    }
}
