// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables as files: CSV that every reader accepts, and Parquet. The module does not depend on the
//! meaning of the rows.

mod parquet;
mod table;
mod value;

pub use self::parquet::ParquetWriter;
pub use table::{NamedCells, Table, TableCell, csv_text, escape_name, named_cells};
pub use value::{Column, ColumnType, TableValue};
