// SPDX-License-Identifier: MIT OR Apache-2.0
//! The formats of a timing diagram: that of WaveDrom ([`WaveDiagram`]), which has a row of
//! characters for each signal and numbers for some of them, and the SVG that is drawn of it
//! ([`draw_svg`]).

use super::trace::{DiagramColumn, PortTrace};
use serde::Serialize;
use std::fmt::Write as _;

const COLUMN_WIDTH: usize = 44;
const ROW_HEIGHT: usize = 28;
/// The height of a signal in its row.
const SIGNAL_HEIGHT: usize = 18;
const TOP_MARGIN: usize = 44;
const BOTTOM_MARGIN: usize = 34;
/// The width of a character of a name.
const LETTER_WIDTH: usize = 8;
/// The width of the slanted part of a change.
const SLANT_WIDTH: usize = 4;

/// Returns the diagram as SVG on white.
pub(super) fn draw_svg(wave: &WaveDiagram) -> String {
    let names = wave.signal.iter().map(|row| row.name.len()).max().unwrap_or(0);
    let columns = wave.signal.iter().map(|row| row.wave.len()).max().unwrap_or(0);
    let left = names * LETTER_WIDTH + 24;
    let texts = wave.foot.text.len().max(wave.head.text.len()) * 7 + 20;
    let width = (left + columns * COLUMN_WIDTH + 12).max(texts);
    let height = TOP_MARGIN + wave.signal.len() * ROW_HEIGHT + BOTTOM_MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"ui-monospace, Menlo, Consolas, monospace\" font-size=\"13\">\n\
         <title>{title}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n\
         <text x=\"10\" y=\"24\" font-weight=\"bold\">{title}</text>\n",
        title = escape_xml(&wave.head.text),
    );
    for (number, row) in wave.signal.iter().enumerate() {
        draw_row(&mut svg, row, left, TOP_MARGIN + number * ROW_HEIGHT);
    }
    let gaps = wave.signal.first().map_or("", |row| row.wave.as_str());
    for (column, _) in gaps.char_indices().filter(|&(_, shown)| shown == '|') {
        draw_gap(
            &mut svg,
            left + column * COLUMN_WIDTH,
            TOP_MARGIN,
            TOP_MARGIN + wave.signal.len() * ROW_HEIGHT - 4,
        );
    }
    // Writing to a string cannot fail.
    let _ = write!(
        svg,
        "<text x=\"10\" y=\"{}\" font-size=\"11\" fill=\"#555555\">{}</text>\n</svg>\n",
        height - 12,
        escape_xml(&wave.foot.text)
    );
    svg
}

/// The content of consecutive columns with one value.
struct RowPiece<'a> {
    kind: char,
    text: &'a str,
    columns: usize,
}

/// Returns the pieces of a row; a gap continues the value before it.
fn pieces(row: &WaveRow) -> Vec<RowPiece<'_>> {
    let mut pieces: Vec<RowPiece<'_>> = Vec::new();
    let mut data = row.data.iter();
    for shown in row.wave.chars() {
        match (shown, pieces.last_mut()) {
            ('.' | '|', Some(last)) => last.columns += 1,
            _ => {
                let text = if shown == '=' { data.next().map_or("", String::as_str) } else { "" };
                pieces.push(RowPiece { kind: shown, text, columns: 1 });
            }
        }
    }
    pieces
}

fn draw_row(svg: &mut String, row: &WaveRow, left: usize, top: usize) {
    let (high, low) = (top, top + SIGNAL_HEIGHT);
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
        left - 10,
        top + SIGNAL_HEIGHT - 5,
        escape_xml(&row.name)
    );
    let mut x = left;
    let mut level = None;
    for piece in pieces(row) {
        let end = x + piece.columns * COLUMN_WIDTH;
        match piece.kind {
            '0' | '1' => {
                let y = if piece.kind == '1' { high } else { low };
                let start = level.filter(|&before| before != y);
                let path = match start {
                    Some(before) => format!("M{x} {before} L{} {y} H{end}", x + SLANT_WIDTH),
                    None => format!("M{x} {y} H{end}"),
                };
                let _ = writeln!(
                    svg,
                    "<path d=\"{path}\" fill=\"none\" stroke=\"#1a1a1a\" stroke-width=\"1.5\"/>"
                );
                level = Some(y);
            }
            kind => {
                let middle = (high + low) / 2;
                let (a, b) = (x + SLANT_WIDTH, end - SLANT_WIDTH);
                let fill = if kind == 'x' { "#e4e4e4" } else { "#dcebf7" };
                let _ = writeln!(
                    svg,
                    "<path d=\"M{x} {middle} L{a} {high} H{b} L{end} {middle} L{b} {low} H{a} Z\" fill=\"{fill}\" stroke=\"#1a1a1a\"/>"
                );
                if !piece.text.is_empty() {
                    let size = if piece.text.len() > 5 { 10 } else { 12 };
                    let _ = writeln!(
                        svg,
                        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"{size}\">{}</text>",
                        x + COLUMN_WIDTH / 2,
                        low - 5,
                        escape_xml(piece.text)
                    );
                }
                level = None;
            }
        }
        x = end;
    }
}

/// Draws two lines through all rows, with white between them.
fn draw_gap(svg: &mut String, x: usize, top: usize, bottom: usize) {
    let (a, b) = (x + COLUMN_WIDTH / 2 - 5, x + COLUMN_WIDTH / 2 + 5);
    let _ = writeln!(
        svg,
        "<path d=\"M{a} {top} V{bottom} H{b} V{top} Z\" fill=\"#ffffff\"/>\n\
         <path d=\"M{a} {top} V{bottom} M{b} {top} V{bottom}\" stroke=\"#888888\" stroke-dasharray=\"3 3\"/>"
    );
}

fn escape_xml(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// The name of the row that numbers the edges.
const EDGE_ROW_NAME: &str = "edge of clk_i";

/// A diagram in the format of WaveDrom.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct WaveDiagram {
    pub(super) signal: Vec<WaveRow>,
    pub(super) head: WaveText,
    pub(super) foot: WaveText,
}

/// A line of text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct WaveText {
    pub(super) text: String,
}

/// A signal with one character per column: `0` and `1` for a line, `=` for the next value of
/// `data`, `x` for an invalid value, `.` for no change, and `|` for a gap.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct WaveRow {
    pub(super) name: String,
    pub(super) wave: String,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) data: Vec<String>,
}

impl WaveDiagram {
    pub(super) fn from_trace(trace: &PortTrace, columns: &[DiagramColumn]) -> Self {
        let mut rows = vec![edge_row(columns)];
        rows.extend((0..trace.signals.len()).map(|signal| signal_row(trace, signal, columns)));
        let foot = "A column shows the inputs of an edge and the outputs after it; edge 0 takes the first pixel of a first frame.";
        Self {
            signal: rows,
            head: WaveText { text: trace.title.clone() },
            foot: WaveText { text: foot.to_owned() },
        }
    }

    /// Returns the diagram as WaveJSON, with one signal per line.
    pub(super) fn json(&self) -> String {
        let rows: Vec<_> = self.signal.iter().map(|row| format!("    {}", to_json(row))).collect();
        format!(
            "{{\n  \"signal\": [\n{}\n  ],\n  \"head\": {},\n  \"foot\": {}\n}}\n",
            rows.join(",\n"),
            to_json(&self.head),
            to_json(&self.foot)
        )
    }
}

fn to_json(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("texts and lists of texts have JSON")
}

fn edge_row(columns: &[DiagramColumn]) -> WaveRow {
    let mut row = WaveRow { name: EDGE_ROW_NAME.to_owned(), wave: String::new(), data: Vec::new() };
    for column in columns {
        match column {
            DiagramColumn::Clock { edge, .. } => {
                row.wave.push('=');
                row.data.push(edge.to_string());
            }
            DiagramColumn::Gap => row.wave.push('|'),
        }
    }
    row
}

fn signal_row(trace: &PortTrace, signal: usize, columns: &[DiagramColumn]) -> WaveRow {
    let shown = &trace.signals[signal];
    let mut row = WaveRow { name: shown.name.clone(), wave: String::new(), data: Vec::new() };
    let mut before: Option<Option<u64>> = None;
    for column in columns {
        let &DiagramColumn::Clock { stretch, .. } = column else {
            row.wave.push('|');
            // The value of a number may have changed in the gap.
            before = before.filter(|_| shown.is_bit);
            continue;
        };
        let value = trace.stretches[stretch].values[signal];
        if before == Some(value) {
            row.wave.push('.');
        } else {
            row.wave.push(match value {
                None => 'x',
                Some(0) if shown.is_bit => '0',
                Some(_) if shown.is_bit => '1',
                Some(value) => {
                    row.data.push(value.to_string());
                    '='
                }
            });
        }
        before = Some(value);
    }
    row
}
