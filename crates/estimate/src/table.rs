// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table that can be rendered as text for a terminal or as Markdown.

/// A table whose first column is text and whose other columns are figures.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ReportTable {
    /// The title.
    pub title: String,
    /// The names of the columns.
    pub header: Vec<String>,
    /// The rows, with as many cells as the header.
    pub rows: Vec<Vec<String>>,
    /// The text below the rows.
    pub note: Option<String>,
}

const COLUMN_GAP: usize = 2;
const NARROWEST_FIRST_COLUMN: usize = 20;

impl ReportTable {
    /// Returns the table as aligned columns. The first column is truncated where the table would be
    /// wider than `width`, unless too little of it would remain: a terminal that narrow has to
    /// break the lines.
    pub fn text(&self, width: usize) -> String {
        let mut columns = self.widths();
        let figures: usize = columns.iter().skip(1).map(|column| column + COLUMN_GAP).sum();
        let left = width.saturating_sub(figures);
        if let Some(first) = columns.first_mut().filter(|_| left >= NARROWEST_FIRST_COLUMN) {
            *first = (*first).min(left);
        }
        let mut text = wrap(&self.title, width);
        for row in std::iter::once(&self.header).chain(&self.rows) {
            text.push_str(table_line(row, &columns).trim_end());
            text.push('\n');
        }
        if let Some(note) = &self.note {
            text.push_str(&wrap(note, width));
        }
        text
    }

    /// Returns the table as text. Columns that do not fit are placed below the others, after a
    /// repeated first column.
    pub(crate) fn stacked_text(&self, width: usize) -> String {
        let widths = self.widths();
        let first = widths.first().copied().unwrap_or_default();
        let (mut parts, mut used) = (vec![Vec::new()], first);
        for (column, column_width) in widths.iter().enumerate().skip(1) {
            let needed = column_width + COLUMN_GAP;
            if used + needed > width && used > first {
                parts.push(Vec::new());
                used = first;
            }
            used += needed;
            parts.last_mut().into_iter().for_each(|part| part.push(column));
        }
        let last = parts.len() - 1;
        let part = |(number, columns): (usize, &Vec<usize>)| {
            let pick = |row: &Vec<String>| {
                let cells = std::iter::once(&0).chain(columns).filter_map(|&c| row.get(c).cloned());
                cells.collect::<Vec<_>>()
            };
            let table = Self {
                title: if number == 0 { self.title.clone() } else { String::new() },
                header: pick(&self.header),
                rows: self.rows.iter().map(pick).collect(),
                note: self.note.clone().filter(|_| number == last),
            };
            table.text(width)
        };
        parts.iter().enumerate().map(part).collect()
    }

    /// Returns the table as Markdown under its title in bold.
    pub fn markdown(&self) -> String {
        let row = |cells: &[String]| {
            let cells = cells.iter().map(|cell| cell.trim_start().replace('|', "\\|"));
            format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
        };
        let mut text = format!("**{}**\n\n{}| --- |", self.title, row(&self.header));
        text.push_str(&" ---: |".repeat(self.header.len().saturating_sub(1)));
        text.push('\n');
        self.rows.iter().for_each(|cells| text.push_str(&row(cells)));
        if let Some(note) = &self.note {
            text.push_str(&format!("\n{note}\n"));
        }
        text
    }

    fn widths(&self) -> Vec<usize> {
        let mut widths = vec![0; self.header.len()];
        for row in std::iter::once(&self.header).chain(&self.rows) {
            for (width, cell) in widths.iter_mut().zip(row) {
                *width = (*width).max(cell.chars().count());
            }
        }
        widths
    }
}

/// Makes the header of a table from the header of the first column and those of the figures.
pub fn header(first: &str, columns: &[&str]) -> Vec<String> {
    std::iter::once(&first).chain(columns).map(|&text| text.to_owned()).collect()
}

fn table_line(row: &[String], columns: &[usize]) -> String {
    let mut text = String::new();
    for (index, (cell, &width)) in row.iter().zip(columns).enumerate() {
        if index == 0 {
            text.push_str(&format!("{:<width$}", truncated(cell, width)));
        } else {
            text.push_str(&format!("{:>1$}", cell, width + COLUMN_GAP));
        }
    }
    text
}

fn truncated(cell: &str, width: usize) -> String {
    if cell.chars().count() <= width {
        return cell.to_owned();
    }
    let kept: String = cell.chars().take(width.saturating_sub(2)).collect();
    kept + ".."
}

/// Breaks a sentence into lines of at most `width` characters.
pub fn wrap(sentence: &str, width: usize) -> String {
    let mut text = String::new();
    let mut column = 0;
    for word in sentence.split_whitespace() {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > width {
            text.push('\n');
            column = 0;
        } else if column > 0 {
            text.push(' ');
            column += 1;
        }
        text.push_str(word);
        column += length;
    }
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_and_names_cut() {
        let row = |cells: [&str; 2]| cells.map(str::to_owned).to_vec();
        let table = ReportTable {
            title: "T".into(),
            header: row(["module", "LUT"]),
            rows: vec![row(["a_module_with_a_long_name", "1,000"]), row(["b", "1"])],
            note: None,
        };
        let cut = "T\nmodule                  LUT\na_module_with_a_lo..  1,000\nb                         1\n";
        assert_eq!(table.text(27), cut);
        assert!(table.text(15).contains("a_module_with_a_long_name  1,000"), "too narrow to cut");
        assert!(table.markdown().contains("| module | LUT |\n| --- | ---: |\n"));
    }

    #[test]
    fn sentences_are_wrapped() {
        assert_eq!(wrap("one two three", 8), "one two\nthree\n");
    }
}
