// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables that a reader can sort.

use askama::Template;

use super::number::{NONE, grouped, percent};

/// A heading.
#[derive(Clone, Debug)]
pub struct Column {
    /// What is below.
    pub name: String,
    /// Its unit, small.
    pub unit: &'static str,
    /// Said in full.
    pub title: String,
    /// Whether it holds numbers.
    pub numbers: bool,
}

/// A value.
#[derive(Clone, Debug)]
pub struct Cell {
    /// As it is read.
    pub text: String,
    /// What it is sorted by; empty for what comes last.
    pub sort: String,
    /// Class of the cell.
    pub class: &'static str,
}

impl Cell {
    /// Words.
    #[must_use]
    pub fn words(text: String) -> Self {
        Self { sort: text.clone(), text, class: "" }
    }

    /// A number, or none, which is sorted last.
    #[must_use]
    pub fn number(text: String, value: Option<f64>) -> Self {
        let sort = value.filter(|value| value.is_finite()).map(|value| value.to_string());
        Self { text, sort: sort.unwrap_or_default(), class: "number" }
    }

    /// A share in percent.
    #[must_use]
    pub fn share(value: f64) -> Self {
        Self::number(percent(value), Some(value))
    }

    /// A number of things.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "an order")]
    pub fn count(value: u64) -> Self {
        Self::number(grouped(value), Some(value as f64))
    }

    /// No number.
    #[must_use]
    pub fn none() -> Self {
        Self::number(NONE.to_owned(), None)
    }
}

/// A row.
#[derive(Clone, Debug)]
pub struct Row {
    /// What the marks of plots that belong to it are called; one row of the page has it.
    pub id: String,
    /// In the first column.
    pub number: u64,
    /// Whether it stands out.
    pub best: bool,
    /// As many as there are headings after the number.
    pub cells: Vec<Cell>,
}

/// A table.
#[derive(Debug, Template)]
#[template(path = "table.html")]
pub struct Table<'a> {
    /// Before the ids of its rows, to tell them from those of other tables: `p` is what marks lead to.
    pub prefix: &'static str,
    /// What the numbers of the first column are.
    pub number: &'static str,
    /// What a number leads to, the element of that id with `c` before it; empty for nothing.
    pub link: &'static str,
    /// Whether it scrolls in a window of its own.
    pub tall: bool,
    /// Whether rows that stand out are drawn so.
    pub marks_best: bool,
    /// The headings after the number.
    pub columns: &'a [Column],
    /// The rows.
    pub rows: Vec<&'a Row>,
}
