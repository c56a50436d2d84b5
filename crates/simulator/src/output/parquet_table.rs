// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of regions as a Parquet file.

use super::parquet_file::ParquetFile;
use super::row_writer::RowWriter;
use crate::SimulatorError;
use foveate_engine::{EventColumn, EventColumnType, EventFrame, EventTable, EventValue};
use foveate_output::tables::{Column, ColumnType, TableValue};
use std::path::{Path, PathBuf};

/// The open file.
pub(super) struct ParquetTable(ParquetFile);

impl ParquetTable {
    pub(super) fn create(path: &Path, table: &EventTable) -> Result<Self, SimulatorError> {
        let columns: Vec<Column> = table.columns().iter().map(parquet_column).collect();
        Ok(Self(ParquetFile::create(path, "events", &columns)?))
    }
}

impl RowWriter for ParquetTable {
    fn rows(&mut self, table: &EventTable, frame: &EventFrame<'_>) {
        table.rows(frame, |values| self.0.push(values.map(parquet_value)));
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.0.write_out()
    }

    fn expendable(&self) -> Option<PathBuf> {
        Some(self.0.path())
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        self.0.finish()
    }
}

fn parquet_column(EventColumn { name, value_type: kind }: &EventColumn) -> Column {
    let kind = match kind {
        EventColumnType::Long => ColumnType::Long,
        EventColumnType::Int => ColumnType::Int,
        EventColumnType::Flag => ColumnType::Flag,
        EventColumnType::Text => ColumnType::Text,
    };
    Column { name: name.clone(), kind, optional: false }
}

fn parquet_value(value: EventValue) -> TableValue<'static> {
    match value {
        EventValue::Long(value) => TableValue::Long(value),
        EventValue::Int(value) => TableValue::Int(value),
        EventValue::Flag(value) => TableValue::Flag(value),
        EventValue::Text(value) => TableValue::Text(value),
    }
}
