// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of regions as a Parquet file: Snappy, signed integers, booleans and a dictionary of
//! actions, so that every reader takes it. Rows are kept until a group of them is full.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use super::cannot_write;
use super::events::{Field, Kind, RowWriter, Value};
use crate::SimulatorError;

/// Rows of a group: a few megabytes of memory, and few groups in the file's index.
const GROUP: usize = 1 << 18;

/// The values of one column that are not written yet.
enum Column {
    Long(Vec<i64>),
    Int(Vec<i32>),
    Flag(Vec<bool>),
    Text(Vec<ByteArray>),
}

/// The file, open.
pub(super) struct ParquetTable {
    path: PathBuf,
    writer: SerializedFileWriter<File>,
    columns: Vec<Column>,
    rows: usize,
    /// A group could not be written: the file cannot be completed any more.
    broken: bool,
}

impl ParquetTable {
    pub(super) fn create(path: &Path, columns: &[(String, Field)]) -> Result<Self, SimulatorError> {
        let file = File::create(path).map_err(cannot_write(path))?;
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by(concat!("foveate ", env!("CARGO_PKG_VERSION")).to_owned())
            .build();
        let writer = parse_message_type(&schema(columns)).and_then(|schema| {
            SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))
        });
        Ok(Self {
            writer: writer.map_err(failed(path))?,
            path: path.to_owned(),
            columns: columns.iter().map(|(_, field)| Column::new(field.kind())).collect(),
            rows: 0,
            broken: false,
        })
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        for column in &mut self.columns {
            let Some(mut writer) = group.next_column()? else { break };
            match column {
                Column::Long(values) => {
                    writer.typed::<Int64Type>().write_batch(values, None, None)?;
                    values.clear();
                }
                Column::Int(values) => {
                    writer.typed::<Int32Type>().write_batch(values, None, None)?;
                    values.clear();
                }
                Column::Flag(values) => {
                    writer.typed::<BoolType>().write_batch(values, None, None)?;
                    values.clear();
                }
                Column::Text(values) => {
                    writer.typed::<ByteArrayType>().write_batch(values, None, None)?;
                    values.clear();
                }
            }
            writer.close()?;
        }
        group.close()?;
        self.rows = 0;
        Ok(())
    }
}

impl RowWriter for ParquetTable {
    fn row(&mut self, values: &mut dyn Iterator<Item = Value>) {
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(value);
        }
        self.rows += 1;
    }

    fn write_out(&mut self, _all: bool) -> Result<(), SimulatorError> {
        if self.rows < GROUP {
            return Ok(());
        }
        let written = self.write_group();
        self.broken = written.is_err();
        written.map_err(failed(&self.path))
    }

    fn expendable(&self) -> Option<PathBuf> {
        Some(self.path.clone())
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        if self.broken {
            return Err(cannot_write(&self.path)(io::ErrorKind::StorageFull.into()));
        }
        if self.rows > 0 {
            self.write_group().map_err(failed(&self.path))?;
        }
        self.writer.close().map(drop).map_err(failed(&self.path))
    }
}

impl Column {
    fn new(kind: Kind) -> Self {
        match kind {
            Kind::Long => Self::Long(Vec::new()),
            Kind::Int => Self::Int(Vec::new()),
            Kind::Flag => Self::Flag(Vec::new()),
            Kind::Text => Self::Text(Vec::new()),
        }
    }

    fn push(&mut self, value: Value) {
        match (self, value) {
            (Self::Long(values), Value::Long(value)) => values.push(value),
            (Self::Int(values), Value::Int(value)) => values.push(value),
            (Self::Flag(values), Value::Flag(value)) => values.push(value),
            (Self::Text(values), Value::Text(value)) => values.push(value.into()),
            _ => debug_assert!(false, "a value has the kind of its field"),
        }
    }
}

fn schema(columns: &[(String, Field)]) -> String {
    let line = |(name, field): &(String, Field)| match field.kind() {
        Kind::Long => format!("required int64 {name};"),
        Kind::Int => format!("required int32 {name};"),
        Kind::Flag => format!("required boolean {name};"),
        Kind::Text => format!("required binary {name} (string);"),
    };
    format!("message events {{ {} }}", columns.iter().map(line).collect::<String>())
}

fn failed(path: &Path) -> impl Fn(ParquetError) -> SimulatorError + '_ {
    |error| {
        let error = match error {
            // What the system said, so that a full disk is recognized.
            ParquetError::External(cause) => match cause.downcast::<io::Error>() {
                Ok(cause) => *cause,
                Err(cause) => io::Error::other(cause),
            },
            other => io::Error::other(other),
        };
        cannot_write(path)(error)
    }
}
