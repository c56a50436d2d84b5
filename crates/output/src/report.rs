// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables of text, as aligned columns for a terminal, as Markdown, and as CSV with notes. Reports of
//! such tables and of sentences, as text and as Markdown.

use crate::tables::escape_name;

/// A table of text: columns of words, then columns of figures.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ReportTable {
    /// The title, bold in Markdown; empty for none.
    pub title: String,
    /// The names of the columns.
    pub header: Vec<String>,
    /// The number of columns of words, which Markdown aligns to the left.
    pub words: usize,
    /// The rows, with at most as many cells as the header.
    pub rows: Vec<Vec<String>>,
    /// The paragraphs below the rows.
    pub notes: Vec<String>,
    /// True if columns that do not fit into a terminal are placed below the others, after a repeated first column.
    /// Otherwise the first column is cut, unless too little of it would remain: a terminal that narrow has to break
    /// the lines.
    pub is_stacked: bool,
}

/// A report for people.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Report(pub Vec<ReportPart>);

/// A part of a report. A blank line is between two parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReportPart {
    /// A paragraph.
    Paragraph(String),
    /// Sentences, each on its own lines; in Markdown a list.
    Sentences(Vec<String>),
    /// A table.
    Table(ReportTable),
}

const COLUMN_GAP: usize = 2;
const NARROWEST_FIRST_COLUMN: usize = 20;

impl Report {
    /// Returns the report for a terminal of `width` columns.
    #[must_use]
    pub fn text(&self, width: usize) -> String {
        self.joined(|part| match part {
            ReportPart::Paragraph(text) => wrap(text, width),
            ReportPart::Sentences(all) => all.iter().map(|text| wrap(text, width)).collect(),
            ReportPart::Table(table) => table.text(width),
        })
    }

    /// Returns the report as Markdown.
    #[must_use]
    pub fn markdown(&self) -> String {
        self.joined(|part| match part {
            ReportPart::Paragraph(text) => format!("{text}\n"),
            ReportPart::Sentences(all) => all.iter().map(|text| format!("* {text}\n")).collect(),
            ReportPart::Table(table) => table.markdown(),
        })
    }

    fn joined(&self, part: impl Fn(&ReportPart) -> String) -> String {
        self.0.iter().map(part).collect::<Vec<_>>().join("\n")
    }
}

impl ReportTable {
    /// Makes a table of one column of words and columns of figures, without a title.
    #[must_use]
    pub fn new<S: Into<String>>(
        header: impl IntoIterator<Item = S>,
        rows: impl IntoIterator<Item: IntoIterator<Item = String>>,
    ) -> Self {
        Self {
            header: header.into_iter().map(Into::into).collect(),
            words: 1,
            rows: rows.into_iter().map(|row| row.into_iter().collect()).collect(),
            ..Self::default()
        }
    }

    /// Returns the table with a title and paragraphs below it.
    #[must_use]
    pub fn described(
        self,
        title: impl Into<String>,
        notes: impl IntoIterator<Item = String>,
    ) -> Self {
        Self { title: title.into(), notes: notes.into_iter().collect(), ..self }
    }

    /// Makes a table of columns of words, without rows.
    #[must_use]
    pub fn of_words<S: Into<String>>(header: impl IntoIterator<Item = S>) -> Self {
        let header: Vec<String> = header.into_iter().map(Into::into).collect();
        Self { words: header.len(), header, ..Self::default() }
    }

    /// Returns the table as aligned columns for a terminal of `width` columns.
    #[must_use]
    pub fn text(&self, width: usize) -> String {
        let widths = self.widths();
        let of_column = |column: usize| widths.get(column).copied().unwrap_or_default();
        let mut parts = vec![Vec::new()];
        let mut used = of_column(0);
        for column in 1..widths.len() {
            let needed = of_column(column) + COLUMN_GAP;
            if self.is_stacked && used + needed > width && used > of_column(0) {
                parts.push(Vec::new());
                used = of_column(0);
            }
            used += needed;
            parts.last_mut().into_iter().for_each(|part| part.push(column));
        }
        let mut text = if self.title.is_empty() { String::new() } else { wrap(&self.title, width) };
        for (number, columns) in parts.iter().enumerate() {
            if number > 0 {
                text.push('\n');
            }
            let figures: usize = columns.iter().map(|&column| of_column(column) + COLUMN_GAP).sum();
            let left = width.saturating_sub(figures);
            let first = of_column(0);
            let first = if left >= NARROWEST_FIRST_COLUMN { first.min(left) } else { first };
            for row in std::iter::once(&self.header).chain(&self.rows) {
                let cell = |column: usize| row.get(column).map_or("", String::as_str);
                let mut line = format!("{:<first$}", truncated(cell(0), first));
                for &column in columns {
                    line += &format!("{:>1$}", cell(column), of_column(column) + COLUMN_GAP);
                }
                text += line.trim_end();
                text.push('\n');
            }
        }
        text.extend(self.notes.iter().map(|note| wrap(note, width)));
        text
    }

    /// Returns the table as Markdown. Cells stay on their line.
    #[must_use]
    pub fn markdown(&self) -> String {
        let row = |cells: &Vec<String>| {
            let cell =
                |cell: &String| cell.trim_start().replace('|', "\\|").replace(['\n', '\r'], " ");
            format!("| {} |\n", cells.iter().map(cell).collect::<Vec<_>>().join(" | "))
        };
        let mut text = match self.title.as_str() {
            "" => String::new(),
            title => format!("**{title}**\n\n"),
        };
        let sides = (0..self.header.len())
            .map(|column| if column < self.words { " --- |" } else { " ---: |" });
        text += &format!("{}|{}\n", row(&self.header), sides.collect::<String>());
        text.extend(self.rows.iter().map(row));
        text.extend(self.notes.iter().map(|note| format!("\n{note}\n")));
        text
    }

    /// Returns the table as CSV, with each of the `comments` as a line before it. Special characters
    /// of cells are escaped, so that readers that skip comments keep them whole.
    #[must_use]
    pub fn csv(&self, comments: &[String]) -> String {
        let comment = |text: &String| format!("# {}\n", text.replace(['\n', '\r'], " "));
        let row = |cells: &Vec<String>| {
            cells.iter().map(|cell| escape_name(cell)).collect::<Vec<_>>().join(",") + "\n"
        };
        let rows = std::iter::once(&self.header).chain(&self.rows);
        comments.iter().map(comment).chain(rows.map(row)).collect()
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

fn truncated(cell: &str, width: usize) -> String {
    if cell.chars().count() <= width {
        return cell.to_owned();
    }
    let kept: String = cell.chars().take(width.saturating_sub(2)).collect();
    kept + ".."
}

/// Breaks a sentence into lines of at most `width` characters.
fn wrap(sentence: &str, width: usize) -> String {
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
        let row = |cells: [&str; 2]| cells.map(str::to_owned);
        let rows = [row(["a_module_with_a_long_name", "1,000"]), row(["b", "1"])];
        let table = ReportTable::new(["module", "LUT"], rows).described("T", None);
        let cut = "T\nmodule                  LUT\na_module_with_a_lo..  1,000\nb                         1\n";
        assert_eq!(table.text(27), cut);
        assert!(table.text(15).contains("a_module_with_a_long_name  1,000"), "too narrow to cut");
        assert!(table.markdown().contains("| module | LUT |\n| --- | ---: |\n"));
    }

    #[test]
    fn cells_are_plain() {
        let mut table = ReportTable::of_words(["a", "b"]);
        table.rows.push(["x, \"y\"", "1|\n2"].map(str::to_owned).to_vec());
        assert_eq!(table.csv(&["of\nme".to_owned()]), "# of me\na,b\nx%2C %22y%22,1|%0A2\n");
        assert_eq!(table.markdown(), "| a | b |\n| --- | --- |\n| x, \"y\" | 1\\| 2 |\n");
    }

    #[test]
    fn sentences_are_wrapped() {
        assert_eq!(wrap("one two three", 8), "one two\nthree\n");
    }
}
