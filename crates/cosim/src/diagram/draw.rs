// SPDX-License-Identifier: MIT OR Apache-2.0
//! A diagram drawn as SVG: lines, boxes with numbers, and gaps.

use super::wave::{Wave, WaveRow};
use std::fmt::Write as _;

const COLUMN: usize = 44;
const ROW: usize = 28;
/// The height of a signal in its row.
const SWING: usize = 18;
const TOP: usize = 44;
const BOTTOM: usize = 34;
/// The width of a character of a name.
const LETTER: usize = 8;
/// The width of the slanted part of a change.
const SLANT: usize = 4;

/// Returns the diagram as SVG on white.
pub(super) fn svg(wave: &Wave) -> String {
    let names = wave.signal.iter().map(|row| row.name.len()).max().unwrap_or(0);
    let columns = wave.signal.iter().map(|row| row.wave.len()).max().unwrap_or(0);
    let left = names * LETTER + 24;
    let texts = wave.foot.text.len().max(wave.head.text.len()) * 7 + 20;
    let width = (left + columns * COLUMN + 12).max(texts);
    let height = TOP + wave.signal.len() * ROW + BOTTOM;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"ui-monospace, Menlo, Consolas, monospace\" font-size=\"13\">\n\
         <title>{title}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n\
         <text x=\"10\" y=\"24\" font-weight=\"bold\">{title}</text>\n",
        title = escaped(&wave.head.text),
    );
    for (number, row) in wave.signal.iter().enumerate() {
        draw_row(&mut svg, row, left, TOP + number * ROW);
    }
    let gaps = wave.signal.first().map_or("", |row| row.wave.as_str());
    for (column, _) in gaps.char_indices().filter(|&(_, shown)| shown == '|') {
        draw_gap(&mut svg, left + column * COLUMN, TOP, TOP + wave.signal.len() * ROW - 4);
    }
    // Writing to a string cannot fail.
    let _ = write!(
        svg,
        "<text x=\"10\" y=\"{}\" font-size=\"11\" fill=\"#555555\">{}</text>\n</svg>\n",
        height - 12,
        escaped(&wave.foot.text)
    );
    svg
}

/// The content of consecutive columns with one value.
struct Piece<'a> {
    kind: char,
    text: &'a str,
    columns: usize,
}

/// Returns the pieces of a row; a gap continues the value before it.
fn pieces(row: &WaveRow) -> Vec<Piece<'_>> {
    let mut pieces: Vec<Piece<'_>> = Vec::new();
    let mut data = row.data.iter();
    for shown in row.wave.chars() {
        match (shown, pieces.last_mut()) {
            ('.' | '|', Some(last)) => last.columns += 1,
            _ => {
                let text = if shown == '=' { data.next().map_or("", String::as_str) } else { "" };
                pieces.push(Piece { kind: shown, text, columns: 1 });
            }
        }
    }
    pieces
}

fn draw_row(svg: &mut String, row: &WaveRow, left: usize, top: usize) {
    let (high, low) = (top, top + SWING);
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
        left - 10,
        top + SWING - 5,
        escaped(&row.name)
    );
    let mut x = left;
    let mut level = None;
    for piece in pieces(row) {
        let end = x + piece.columns * COLUMN;
        match piece.kind {
            '0' | '1' => {
                let y = if piece.kind == '1' { high } else { low };
                let start = level.filter(|&before| before != y);
                let path = match start {
                    Some(before) => format!("M{x} {before} L{} {y} H{end}", x + SLANT),
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
                let (a, b) = (x + SLANT, end - SLANT);
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
                        x + COLUMN / 2,
                        low - 5,
                        escaped(piece.text)
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
    let (a, b) = (x + COLUMN / 2 - 5, x + COLUMN / 2 + 5);
    let _ = writeln!(
        svg,
        "<path d=\"M{a} {top} V{bottom} H{b} V{top} Z\" fill=\"#ffffff\"/>\n\
         <path d=\"M{a} {top} V{bottom} M{b} {top} V{bottom}\" stroke=\"#888888\" stroke-dasharray=\"3 3\"/>"
    );
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
