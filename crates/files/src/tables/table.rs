// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table in memory, whose columns serve for CSV and Parquet.

use std::io;

use super::{Column, ColumnType, ParquetWriter, TableValue};

/// A value of the table. A missing number is empty in CSV and null in Parquet.
#[derive(Clone, Debug, PartialEq)]
pub enum TableCell {
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
    pub rows: Vec<Vec<TableCell>>,
}

/// The cells of a row with their column names.
pub type NamedCells = Vec<(String, TableCell)>;

impl Table {
    /// Makes a table from rows that have the same columns.
    #[must_use]
    pub fn from_rows(rows: impl Iterator<Item = NamedCells>) -> Self {
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
    pub fn to_csv(&self) -> String {
        let fields =
            |row: &Vec<TableCell>| row.iter().map(|cell| cell.value().to_string()).collect();
        super::csv_text(std::iter::once(self.columns.clone()).chain(self.rows.iter().map(fields)))
    }

    /// Returns the table as Parquet, with one group of rows called `message`.
    ///
    /// # Errors
    /// Fails if Parquet does not allow the name of a column.
    pub fn to_parquet(&self, message: &str) -> io::Result<Vec<u8>> {
        // The cells of the first row show the types of the columns.
        let cells = self.rows.first().into_iter().flatten();
        let columns = self.columns.iter().zip(cells).map(|(name, cell)| cell.column(name));
        let mut file = ParquetWriter::new(Vec::new(), message, &columns.collect::<Vec<_>>())?;
        for row in &self.rows {
            file.push(row.iter().map(TableCell::value));
        }
        file.finish()
    }
}

impl TableCell {
    /// Returns the column for cells of this variant. Points are replaced in the name, because
    /// Parquet uses them for nested columns.
    fn column(&self, name: &str) -> Column {
        let (kind, optional) = match self {
            Self::Text(_) => (ColumnType::Text, false),
            Self::Count(_) => (ColumnType::Long, true),
            Self::Real(_) => (ColumnType::Real, true),
            Self::Flag(_) => (ColumnType::Flag, false),
        };
        Column { name: name.replace('.', "_"), kind, optional }
    }

    fn value(&self) -> TableValue<'_> {
        match self {
            Self::Text(text) => TableValue::Text(text),
            Self::Count(Some(count)) => {
                TableValue::Long(i64::try_from(*count).expect("nothing is counted up to 2^63"))
            }
            Self::Real(Some(value)) => TableValue::Real(*value),
            Self::Flag(flag) => TableValue::Flag(*flag),
            Self::Count(None) | Self::Real(None) => TableValue::None,
        }
    }
}
