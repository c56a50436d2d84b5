// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of regions as a Parquet file.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use foveate_engine::{EventColumn, EventKind, EventTable, EventValue, Moment};
use foveate_files::tables::{Column, Kind, ParquetWriter, Value};

use super::cannot_write;
use super::row_writer::RowWriter;
use crate::SimulatorError;

/// The number of rows of a group: a few megabytes of memory, and few groups in the file's index.
const GROUP: usize = 1 << 18;

/// The open file.
pub(super) struct ParquetTable {
    path: PathBuf,
    writer: ParquetWriter<File>,
    /// A group could not be written, so the file cannot be completed.
    broken: bool,
}

impl ParquetTable {
    pub(super) fn create(path: &Path, table: &EventTable) -> Result<Self, SimulatorError> {
        let columns: Vec<Column> = table.columns().iter().map(column).collect();
        let file = File::create(path).map_err(cannot_write(path))?;
        let writer = ParquetWriter::new(file, "events", &columns).map_err(cannot_write(path))?;
        Ok(Self { path: path.to_owned(), writer, broken: false })
    }
}

impl RowWriter for ParquetTable {
    fn rows(&mut self, table: &EventTable, moment: &Moment<'_>) {
        table.rows(moment, |values| self.writer.push(values.map(value)));
    }

    fn write_out(&mut self, _all: bool) -> Result<(), SimulatorError> {
        if self.writer.pending() < GROUP {
            return Ok(());
        }
        let written = self.writer.write_group();
        self.broken = written.is_err();
        written.map_err(cannot_write(&self.path))
    }

    fn expendable(&self) -> Option<PathBuf> {
        Some(self.path.clone())
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        let Self { path, writer, broken } = *self;
        if broken {
            return Err(cannot_write(&path)(io::ErrorKind::StorageFull.into()));
        }
        writer.finish().map(drop).map_err(cannot_write(&path))
    }
}

fn column(EventColumn { name, kind }: &EventColumn) -> Column {
    let kind = match kind {
        EventKind::Long => Kind::Long,
        EventKind::Int => Kind::Int,
        EventKind::Flag => Kind::Flag,
        EventKind::Text => Kind::Text,
    };
    Column { name: name.clone(), kind, optional: false }
}

fn value(value: EventValue) -> Value<'static> {
    match value {
        EventValue::Long(value) => Value::Long(value),
        EventValue::Int(value) => Value::Int(value),
        EventValue::Flag(value) => Value::Flag(value),
        EventValue::Text(value) => Value::Text(value),
    }
}
