// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table in memory, whose columns serve for CSV and Parquet ([`Table`]). Records without a
//! table are written as CSV in the same way ([`csv_text`]).

use super::{Column, ColumnType, ParquetWriter, TableValue};
use std::fmt::Write as _;
use std::io;

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

impl From<u64> for TableCell {
    fn from(count: u64) -> Self {
        Self::Count(Some(count))
    }
}

impl From<f64> for TableCell {
    fn from(value: f64) -> Self {
        Self::Real(Some(value))
    }
}

impl From<&str> for TableCell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

/// A table of named columns, stored row by row.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The names of the columns.
    pub columns: Vec<String>,
    /// The values of every row, in the order of the columns.
    pub rows: Vec<Vec<TableCell>>,
    /// A row whose cells show the types of the columns.
    example: Vec<TableCell>,
}

/// The cells of a row with their column names.
pub type NamedCells = Vec<(String, TableCell)>;

/// Names the cells of a row, or of a part of it.
#[must_use]
pub fn named_cells<const N: usize>(cells: [(&str, TableCell); N]) -> NamedCells {
    cells.map(|(name, cell)| (name.to_owned(), cell)).into()
}

impl Table {
    /// Makes a table from rows that have the same columns. If there may be no rows,
    /// [`Self::with_columns_of`] gives the table its columns.
    #[must_use]
    pub fn from_rows(rows: impl Iterator<Item = NamedCells>) -> Self {
        let mut table = Self::default();
        for row in rows {
            let (columns, cells) = row.into_iter().unzip();
            table.columns = columns;
            table.rows.push(cells);
        }
        table.example = table.rows.first().cloned().unwrap_or_default();
        table
    }

    /// Takes the columns from `example`, a row that is not in the table, if the table has no rows.
    /// Its files then have the names and the types of the columns all the same.
    #[must_use]
    pub fn with_columns_of(mut self, example: NamedCells) -> Self {
        if self.rows.is_empty() {
            (self.columns, self.example) = example.into_iter().unzip();
        }
        self
    }

    /// Returns the table as CSV with a line of names.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let fields =
            |row: &Vec<TableCell>| row.iter().map(|cell| cell.value().to_string()).collect();
        csv_text(std::iter::once(self.columns.clone()).chain(self.rows.iter().map(fields)))
    }

    /// Returns the table as Parquet, with one group of rows called `message`.
    ///
    /// # Errors
    /// Fails if Parquet does not allow the name of a column.
    pub fn to_parquet(&self, message: &str) -> io::Result<Vec<u8>> {
        let cells = self.columns.iter().zip(&self.example);
        let columns = cells.map(|(name, cell)| cell.column(name));
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

/// Returns a CSV file (RFC 4180). All records have the same number of fields; fields are quoted
/// where necessary.
///
/// # Panics
/// Panics if the number of fields of a record differs from that of the first.
#[must_use]
pub fn csv_text<R>(records: impl IntoIterator<Item = R>) -> String
where
    R: IntoIterator<Item: AsRef<[u8]>>,
{
    let mut file = csv::Writer::from_writer(Vec::new());
    for record in records {
        file.write_record(record).expect("memory takes everything, and records are alike");
    }
    let bytes = file.into_inner().expect("memory takes everything");
    String::from_utf8(bytes).expect("fields are text")
}

/// Escapes a name so that every reader accepts it unchanged, even one that supports neither quotes
/// nor a `#` in a name. The characters `,` `#` `"` `%` and control characters are written as in a
/// URL (`%2C`).
#[must_use]
pub fn escape_name(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for letter in name.chars() {
        match letter {
            ',' | '#' | '"' | '%' | '\0'..='\x1F' | '\x7F' => {
                let _ = write!(text, "%{:02X}", u32::from(letter));
            }
            other => text.push(other),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use std::io::Write as _;

    fn row(name: &str, count: u64) -> NamedCells {
        named_cells([
            ("name", name.into()),
            ("count", count.into()),
            ("share", TableCell::Real(None)),
            ("holds", TableCell::Flag(true)),
        ])
    }

    #[test]
    fn a_table_without_rows_has_the_columns_of_one_with_rows() {
        let full = Table::from_rows([row("a", 3)].into_iter()).with_columns_of(row("other", 4));
        let empty = Table::from_rows(std::iter::empty()).with_columns_of(row("other", 4));
        assert_eq!(full.to_csv(), "name,count,share,holds\na,3,,true\n");
        assert_eq!(empty.to_csv(), "name,count,share,holds\n");
        let [full, empty] = [full, empty].map(|table| {
            let mut file = tempfile::tempfile().unwrap();
            file.write_all(&table.to_parquet("rows").unwrap()).unwrap();
            let reader = SerializedFileReader::new(file).unwrap();
            let about = reader.metadata().file_metadata().clone();
            (about.schema().clone(), about.num_rows())
        });
        assert_eq!((full.1, empty.1), (1, 0));
        assert_eq!(full.0, empty.0);
        assert_eq!(empty.0.get_fields().len(), 4);
    }

    #[test]
    fn fields_are_quoted_only_where_necessary() {
        let records = [["name", "b"], ["a b.png", ""], ["a,\"b\".png", "c\nd"]];
        assert_eq!(csv_text(records), "name,b\na b.png,\n\"a,\"\"b\"\".png\",\"c\nd\"\n");
    }

    #[test]
    fn escaped_names_need_no_quotes() {
        assert_eq!(escape_name("clips/a b-1_\u{fc}.png"), "clips/a b-1_\u{fc}.png");
        assert_eq!(escape_name("a,\"b\"#1 50%\n.png"), "a%2C%22b%22%231 50%25%0A.png");
        assert_eq!(csv_text([[escape_name("a,\"\r")]]), escape_name("a,\"\r") + "\n");
    }
}
