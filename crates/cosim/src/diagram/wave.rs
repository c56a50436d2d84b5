// SPDX-License-Identifier: MIT OR Apache-2.0
//! A diagram in the format of WaveDrom: a row of characters for each signal, and numbers for some
//! of them.

use super::column_choice::DiagramColumn;
use super::trace::PortTrace;
use serde::Serialize;

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
