// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables that a reader can sort.

use askama::Template;

use crate::number_text::{MISSING, grouped, percent, real_number};

/// A column of a table.
#[derive(Clone, Debug)]
pub struct TableColumn {
    /// The heading of the column.
    pub name: String,
    /// The unit, in small letters.
    pub unit: &'static str,
    /// The full description of the column, for its tooltip.
    pub title: String,
    /// True if the column has numbers.
    pub numbers: bool,
}

/// A value of a table.
#[derive(Clone, Debug)]
pub struct TableCell {
    /// The text of the cell.
    pub text: String,
    /// The sort key; cells with an empty key come last.
    pub sort: String,
    /// The class of the cell.
    pub class: &'static str,
}

impl TableCell {
    /// Makes a cell of text.
    #[must_use]
    pub fn text(text: String) -> Self {
        Self { sort: text.clone(), text, class: "" }
    }

    /// Makes a cell of a number, or of a missing number, which comes last in any order.
    #[must_use]
    pub fn number(text: String, value: Option<f64>) -> Self {
        let sort = value.filter(|value| value.is_finite()).map(|value| value.to_string());
        Self { text, sort: sort.unwrap_or_default(), class: "number" }
    }

    /// Makes a cell of a share in percent.
    #[must_use]
    pub fn share(value: f64) -> Self {
        Self::number(percent(value), Some(value))
    }

    /// Makes a cell of a count.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "an order")]
    pub fn count(value: u64) -> Self {
        Self::number(grouped(value), Some(value as f64))
    }

    /// Makes a cell of a PSNR in decibels. Equal frames have no PSNR and are the best.
    #[must_use]
    pub fn psnr(psnr: Option<f64>) -> Self {
        match psnr {
            Some(psnr) => Self::number(real_number(psnr, 1), Some(psnr)),
            None => Self { text: "=".to_owned(), sort: "1e9".to_owned(), class: "number" },
        }
    }

    /// Makes a cell without a number.
    #[must_use]
    pub fn missing() -> Self {
        Self::number(MISSING.to_owned(), None)
    }
}

/// A row of a table.
#[derive(Clone, Debug)]
pub struct TableRow {
    /// The id that the marks of this row have in plots; one row of the page has it.
    pub id: String,
    /// The number in the first column.
    pub number: u64,
    /// True if the row is highlighted.
    pub best: bool,
    /// The cells after the number, one for each column.
    pub cells: Vec<TableCell>,
    /// The text of the marks of this row in plots.
    pub mark_title: String,
}

/// A table of rows.
#[derive(Debug, Template)]
#[template(path = "table.html")]
pub struct SortableTable {
    /// The prefix of the ids of its rows, which distinguishes them from those of other tables;
    /// marks link to the prefix `p`.
    pub prefix: &'static str,
    /// The meaning of the numbers in the first column, for the tooltip of its heading.
    pub number: &'static str,
    /// The tooltip of a link from the number to the element with the prefix `c` before its id;
    /// empty for no link.
    pub link: &'static str,
    /// True if the table scrolls in a window of its own.
    pub tall: bool,
    /// True if highlighted rows are drawn as such.
    pub marks_best: bool,
    /// The columns after the number.
    pub columns: Vec<TableColumn>,
    /// The rows.
    pub rows: Vec<TableRow>,
}
