// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of clocks, as `clocks.npy` has it.

use foveate_timed::ClockRow;
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;

/// The numbers of the columns, row by row.
#[derive(Default)]
pub(crate) struct ClockTable(Vec<i64>);

impl ClockTable {
    pub(crate) fn push(&mut self, row: &ClockRow) {
        self.0.extend(row.numbers().map(u64::cast_signed));
    }

    /// Returns the table as a structured array.
    pub(crate) fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        const COLUMNS: usize = ClockRow::COLUMNS.len();
        let size = [self.0.len() / COLUMNS, COLUMNS];
        let numbers = self.0.into_pyarray(py).reshape(size)?;
        py.import("foveate._tables")?.call_method1("clock_rows", (numbers,))
    }
}
