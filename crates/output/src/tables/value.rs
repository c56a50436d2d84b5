// SPDX-License-Identifier: MIT OR Apache-2.0
//! The columns and values of a table.

use std::fmt;

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// The name of the column.
    pub name: String,
    /// The type of its values.
    pub kind: ColumnType,
    /// True if a row may have no value.
    pub optional: bool,
}

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnType {
    /// A signed integer of 64 bits.
    Long,
    /// A signed integer of 32 bits.
    Int,
    /// A floating-point number of 64 bits.
    Real,
    /// A truth value.
    Flag,
    /// A text.
    Text,
}

/// A value of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableValue<'a> {
    /// No value: null in Parquet, and empty as text.
    None,
    /// A value of [`ColumnType::Long`].
    Long(i64),
    /// A value of [`ColumnType::Int`].
    Int(i32),
    /// A value of [`ColumnType::Real`].
    Real(f64),
    /// A value of [`ColumnType::Flag`].
    Flag(bool),
    /// A value of [`ColumnType::Text`].
    Text(&'a str),
}

impl fmt::Display for TableValue<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => Ok(()),
            Self::Long(value) => value.fmt(f),
            Self::Int(value) => value.fmt(f),
            Self::Real(value) => value.fmt(f),
            Self::Flag(value) => value.fmt(f),
            Self::Text(value) => f.write_str(value),
        }
    }
}
