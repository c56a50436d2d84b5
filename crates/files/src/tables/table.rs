// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table in memory, whose columns serve for CSV and Parquet.

use std::io;

use super::{Column, Kind, ParquetWriter, Value};

/// A value of the table. A missing number is empty in CSV and null in Parquet.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A text.
    Text(String),
    /// A count.
    Count(Option<u64>),
    /// A real number.
    Real(Option<f64>),
    /// A truth value.
    Flag(bool),
}

/// A table of named columns, stored row by row.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The names of the columns.
    pub columns: Vec<String>,
    /// The values of every row, in the order of the columns.
    pub rows: Vec<Vec<Cell>>,
}

/// The cells of a row with their column names.
pub type Cells = Vec<(String, Cell)>;

impl Table {
    /// Makes a table from rows that have the same columns.
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

    /// Returns the table as CSV with a line of names.
    #[must_use]
    pub fn csv(&self) -> String {
        let row = |row: &Vec<Cell>| row.iter().map(|cell| cell.value().to_string()).collect();
        super::csv(std::iter::once(self.columns.clone()).chain(self.rows.iter().map(row)))
    }

    /// Returns the table as Parquet, with one group of rows called `message`.
    ///
    /// # Errors
    /// Fails if Parquet does not allow the name of a column.
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
    /// Returns the column for cells of this variant. Points are replaced in the name, because
    /// Parquet uses them for nested columns.
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
