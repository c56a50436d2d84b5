// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables as files: CSV that every reader takes, and Parquet. Knows nothing of what the rows are about.

mod parquet;
mod table;
mod text;
mod value;

pub use self::parquet::ParquetWriter;
pub use table::{Cell, Cells, Table};
pub use text::{csv, plain};
pub use value::{Column, Kind, Value};
