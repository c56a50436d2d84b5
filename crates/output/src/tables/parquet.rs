// SPDX-License-Identifier: MIT OR Apache-2.0
//! Parquet files with Snappy compression and signed integers, so that every reader accepts them.
//! Rows are kept in memory until their group is written.

use std::fmt;
use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int32Type, Int64Type,
};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::parser::parse_message_type;

use super::{Column, ColumnType, TableValue};

/// An open Parquet file.
pub struct ParquetWriter<W: Write + Send> {
    file: SerializedFileWriter<W>,
    columns: Vec<PendingColumn>,
    rows: usize,
}

/// The values of a column that are not written yet.
struct PendingColumn {
    values: ColumnValues,
    /// The definition levels of an optional column: for each row, 1 with a value and 0 without.
    definition_levels: Option<Vec<i16>>,
}

enum ColumnValues {
    Long(Vec<i64>),
    Int(Vec<i32>),
    Real(Vec<f64>),
    Flag(Vec<bool>),
    Text(Vec<ByteArray>),
}

impl<W: Write + Send> ParquetWriter<W> {
    /// Starts a file of rows called `message`.
    ///
    /// # Errors
    /// Fails if `to` cannot be written, or if Parquet does not allow the name of a column.
    pub fn new(to: W, message: &str, columns: &[Column]) -> io::Result<Self> {
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by(concat!("foveate ", env!("CARGO_PKG_VERSION")).to_owned())
            .build();
        let schema = parse_message_type(&schema(message, columns)).map_err(io_error)?;
        let file = SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties));
        let columns = columns.iter().map(PendingColumn::new).collect();
        Ok(Self { file: file.map_err(io_error)?, columns, rows: 0 })
    }

    /// Adds a row with a value for each column.
    ///
    /// # Panics
    /// Panics if the type of a value is not that of its column, or if a required value is missing.
    pub fn push<'a>(&mut self, row: impl IntoIterator<Item = TableValue<'a>>) {
        for (column, value) in self.columns.iter_mut().zip(row) {
            column.push(value);
        }
        self.rows += 1;
    }

    /// Returns the number of rows that are not written yet.
    #[must_use]
    pub fn pending_rows(&self) -> usize {
        self.rows
    }

    /// Writes the pending rows as a group.
    ///
    /// # Errors
    /// Fails if the file cannot be written; the file then cannot be completed.
    pub fn write_group(&mut self) -> io::Result<()> {
        self.write_row_group().map_err(io_error)
    }

    /// Writes the remaining rows and the end of the file.
    ///
    /// # Errors
    /// Fails like [`ParquetWriter::write_group`].
    pub fn finish(mut self) -> io::Result<W> {
        if self.rows > 0 {
            self.write_group()?;
        }
        self.file.into_inner().map_err(io_error)
    }

    fn write_row_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.file.next_row_group()?;
        for pending in &mut self.columns {
            let mut column = group.next_column()?.expect("the schema has the same columns");
            pending.write(&mut column)?;
            column.close()?;
        }
        group.close()?;
        self.rows = 0;
        Ok(())
    }
}

impl<W: Write + Send> fmt::Debug for ParquetWriter<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ParquetWriter").field("pending", &self.rows).finish_non_exhaustive()
    }
}

impl PendingColumn {
    fn new(column: &Column) -> Self {
        let values = match column.kind {
            ColumnType::Long => ColumnValues::Long(Vec::new()),
            ColumnType::Int => ColumnValues::Int(Vec::new()),
            ColumnType::Real => ColumnValues::Real(Vec::new()),
            ColumnType::Flag => ColumnValues::Flag(Vec::new()),
            ColumnType::Text => ColumnValues::Text(Vec::new()),
        };
        Self { values, definition_levels: column.optional.then(Vec::new) }
    }

    fn push(&mut self, value: TableValue<'_>) {
        let has_value = value != TableValue::None;
        match &mut self.definition_levels {
            Some(levels) => levels.push(i16::from(has_value)),
            None => assert!(has_value, "every row has a value in a column that is not optional"),
        }
        match (&mut self.values, value) {
            (_, TableValue::None) => {}
            (ColumnValues::Long(values), TableValue::Long(value)) => values.push(value),
            (ColumnValues::Int(values), TableValue::Int(value)) => values.push(value),
            (ColumnValues::Real(values), TableValue::Real(value)) => values.push(value),
            (ColumnValues::Flag(values), TableValue::Flag(value)) => values.push(value),
            (ColumnValues::Text(values), TableValue::Text(value)) => values.push(value.into()),
            (_, value) => panic!("{value:?} is not of the type of its column"),
        }
    }

    fn write(&mut self, column: &mut SerializedColumnWriter<'_>) -> Result<(), ParquetError> {
        let levels = self.definition_levels.as_deref();
        match &mut self.values {
            ColumnValues::Long(values) => write_values::<Int64Type>(column, values, levels)?,
            ColumnValues::Int(values) => write_values::<Int32Type>(column, values, levels)?,
            ColumnValues::Real(values) => write_values::<DoubleType>(column, values, levels)?,
            ColumnValues::Flag(values) => write_values::<BoolType>(column, values, levels)?,
            ColumnValues::Text(values) => write_values::<ByteArrayType>(column, values, levels)?,
        }
        self.definition_levels.iter_mut().for_each(Vec::clear);
        Ok(())
    }
}

fn write_values<T: DataType>(
    column: &mut SerializedColumnWriter<'_>,
    values: &mut Vec<T::T>,
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    column.typed::<T>().write_batch(values, levels, None)?;
    values.clear();
    Ok(())
}

fn schema(message: &str, columns: &[Column]) -> String {
    let line = |Column { name, kind, optional }: &Column| {
        let presence = if *optional { "optional" } else { "required" };
        match kind {
            ColumnType::Long => format!("{presence} int64 {name};"),
            ColumnType::Int => format!("{presence} int32 {name};"),
            ColumnType::Real => format!("{presence} double {name};"),
            ColumnType::Flag => format!("{presence} boolean {name};"),
            ColumnType::Text => format!("{presence} binary {name} (string);"),
        }
    };
    format!("message {message} {{ {} }}", columns.iter().map(line).collect::<String>())
}

/// Returns the error of the system if there is one, so that a full disk is recognized.
fn io_error(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(cause) => {
            cause.downcast::<io::Error>().map_or_else(io::Error::other, |cause| *cause)
        }
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};

    use super::*;

    fn column(name: &str, kind: ColumnType, optional: bool) -> Column {
        Column { name: name.to_owned(), kind, optional }
    }

    #[test]
    fn every_kind_of_value_can_be_read_again_from_every_group() {
        let kinds = [
            ColumnType::Long,
            ColumnType::Int,
            ColumnType::Real,
            ColumnType::Flag,
            ColumnType::Text,
        ];
        let columns: Vec<Column> =
            (0..).zip(kinds).map(|(at, kind)| column(&format!("c{at}"), kind, true)).collect();
        let full_row = [
            TableValue::Long(-1 << 40),
            TableValue::Int(-7),
            TableValue::Real(0.5),
            TableValue::Flag(true),
            TableValue::Text("a \u{fc}"),
        ];
        let output = tempfile::tempfile().unwrap();
        let mut file = ParquetWriter::new(output, "rows", &columns).unwrap();
        file.push(full_row);
        file.push([TableValue::None; 5]);
        assert_eq!(file.pending_rows(), 2);
        file.write_group().unwrap();
        file.push(full_row);
        let reader = SerializedFileReader::new(file.finish().unwrap()).unwrap();
        assert_eq!(reader.num_row_groups(), 2);
        let text = |row: parquet::record::Row| {
            row.get_column_iter().map(|(_, field)| field.to_string()).collect::<Vec<_>>().join(" ")
        };
        let rows: Vec<String> =
            reader.get_row_iter(None).unwrap().map(|row| text(row.unwrap())).collect();
        let expected = "-1099511627776 -7 0.5 true \"a \u{fc}\"";
        assert_eq!(rows, [expected, "null null null null null", expected]);
    }

    #[test]
    #[should_panic(expected = "every row has a value")]
    fn a_missing_value_of_a_required_column_panics() {
        let mut file =
            ParquetWriter::new(Vec::new(), "rows", &[column("a", ColumnType::Int, false)]).unwrap();
        file.push([TableValue::None]);
    }

    #[test]
    fn a_full_disk_is_distinguished_from_other_errors() {
        let cause = io::Error::from(io::ErrorKind::StorageFull);
        assert_eq!(
            io_error(ParquetError::External(cause.into())).kind(),
            io::ErrorKind::StorageFull
        );
        assert_eq!(io_error(ParquetError::General("x".to_owned())).kind(), io::ErrorKind::Other);
    }
}
