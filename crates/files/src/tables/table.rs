// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table in memory: one list of columns for CSV and Parquet.

use std::io;

use super::{Column, Kind, ParquetWriter, Value};

/// A value of the table. Numbers that are not there are empty in CSV and null in Parquet.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Text.
    Text(String),
    /// A number of things.
    Count(Option<u64>),
    /// A measure.
    Real(Option<f64>),
    /// Yes or no.
    Flag(bool),
}

/// Columns with their values, row by row.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Their names.
    pub columns: Vec<String>,
    /// Values of every row, in the order of the columns.
    pub rows: Vec<Vec<Cell>>,
}

/// The cells of a row with their names.
pub type Cells = Vec<(String, Cell)>;

impl Table {
    /// A table of rows that have the same columns.
    #[must_use]
    pub fn of(rows: impl Iterator<Item = Cells>) -> Self {
        let mut table = Self::default();
        for row in rows {
            let (columns, cells) = row.into_iter().unzip();
            table.columns = columns;
            table.rows.push(cells);
        }
        table
    }

    /// CSV with a line of names.
    #[must_use]
    pub fn csv(&self) -> String {
        let row = |row: &Vec<Cell>| row.iter().map(|cell| cell.value().to_string()).collect();
        super::csv(std::iter::once(self.columns.clone()).chain(self.rows.iter().map(row)))
    }

    /// Parquet: one group of rows called `message`.
    ///
    /// # Errors
    /// When a column has a name that Parquet does not allow.
    pub fn parquet(&self, message: &str) -> io::Result<Vec<u8>> {
        let cells = self.rows.first().into_iter().flatten();
        let columns = self.columns.iter().zip(cells).map(|(name, cell)| cell.column(name));
        let mut file = ParquetWriter::new(Vec::new(), message, &columns.collect::<Vec<_>>())?;
        for row in &self.rows {
            file.push(row.iter().map(Cell::value));
        }
        file.finish()
    }
}

impl Cell {
    /// The column of cells like this one. In the names of Parquet, points are for columns inside columns.
    fn column(&self, name: &str) -> Column {
        let (kind, optional) = match self {
            Self::Text(_) => (Kind::Text, false),
            Self::Count(_) => (Kind::Long, true),
            Self::Real(_) => (Kind::Real, true),
            Self::Flag(_) => (Kind::Flag, false),
        };
        Column { name: name.replace('.', "_"), kind, optional }
    }

    fn value(&self) -> Value<'_> {
        match self {
            Self::Text(text) => Value::Text(text),
            Self::Count(Some(count)) => {
                Value::Long(i64::try_from(*count).expect("nothing is counted up to 2^63"))
            }
            Self::Real(Some(value)) => Value::Real(*value),
            Self::Flag(flag) => Value::Flag(*flag),
            Self::Count(None) | Self::Real(None) => Value::None,
        }
    }
}
