// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of regions as a Parquet file.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use foveate_engine::{EventColumn, EventColumnType, EventFrame, EventTable, EventValue};
use foveate_files::tables::{Column, ColumnType, ParquetWriter, TableValue};

use super::cannot_write;
use super::row_writer::RowWriter;
use crate::SimulatorError;

/// The number of rows of a group: a few megabytes of memory, and few groups in the file's index.
const GROUP_ROWS: usize = 1 << 18;

/// The open file.
pub(super) struct ParquetTable {
    path: PathBuf,
    writer: ParquetWriter<File>,
    /// True if a group could not be written, so that the file cannot be completed.
    is_broken: bool,
}

impl ParquetTable {
    pub(super) fn create(path: &Path, table: &EventTable) -> Result<Self, SimulatorError> {
        let columns: Vec<Column> = table.columns().iter().map(parquet_column).collect();
        let file = File::create(path).map_err(cannot_write(path))?;
        let writer = ParquetWriter::new(file, "events", &columns).map_err(cannot_write(path))?;
        Ok(Self { path: path.to_owned(), writer, is_broken: false })
    }
}

impl RowWriter for ParquetTable {
    fn rows(&mut self, table: &EventTable, frame: &EventFrame<'_>) {
        table.rows(frame, |values| self.writer.push(values.map(parquet_value)));
    }

    fn write_out(&mut self, _all: bool) -> Result<(), SimulatorError> {
        if self.writer.pending_rows() < GROUP_ROWS {
            return Ok(());
        }
        let written = self.writer.write_group();
        self.is_broken = written.is_err();
        written.map_err(cannot_write(&self.path))
    }

    fn expendable(&self) -> Option<PathBuf> {
        Some(self.path.clone())
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        let Self { path, writer, is_broken: broken } = *self;
        if broken {
            return Err(cannot_write(&path)(io::ErrorKind::StorageFull.into()));
        }
        writer.finish().map(drop).map_err(cannot_write(&path))
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
