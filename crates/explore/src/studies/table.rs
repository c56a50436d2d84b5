// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables as CSV for programs and as Markdown for people.

use std::fmt::Write as _;

use foveate_output::tables::escape_name;

/// A table whose cells are rounded text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct StudyTable {
    pub(crate) columns: Vec<&'static str>,
    pub(crate) rows: Vec<Vec<String>>,
}

impl StudyTable {
    pub(crate) fn new(columns: &[&'static str]) -> Self {
        Self { columns: columns.to_vec(), rows: Vec::new() }
    }

    /// Returns the table as CSV. Each of the `notes` is a comment line before it. Special
    /// characters of cells are escaped, so that readers that skip comments keep them whole.
    pub(crate) fn csv(&self, notes: &[String]) -> String {
        let mut text = String::new();
        for note in notes {
            let _ = writeln!(text, "# {}", note.replace(['\n', '\r'], " "));
        }
        let _ = writeln!(text, "{}", self.columns.join(","));
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(|cell| escape_name(cell)).collect();
            let _ = writeln!(text, "{}", cells.join(","));
        }
        text
    }

    pub(crate) fn markdown(&self) -> String {
        let mut text =
            format!("| {} |\n|{}\n", self.columns.join(" | "), " --- |".repeat(self.columns.len()));
        for row in &self.rows {
            let cell = |cell: &String| cell.replace('|', "\\|").replace(['\n', '\r'], " ");
            let cells: Vec<String> = row.iter().map(cell).collect();
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_plain() {
        let mut table = StudyTable::new(&["a", "b"]);
        table.rows.push(vec!["x, \"y\"".to_owned(), "1|\n2".to_owned()]);
        assert_eq!(table.csv(&["of\nme".to_owned()]), "# of me\na,b\nx%2C %22y%22,1|%0A2\n");
        assert_eq!(table.markdown(), "| a | b |\n| --- | --- |\n| x, \"y\" | 1\\| 2 |\n");
    }
}
