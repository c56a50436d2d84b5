// SPDX-License-Identifier: MIT OR Apache-2.0
//! One RPU of each of several designs, row by row, beside the paper's.

use serde::Serialize;

use crate::render::heading;
use crate::report::{PAPER_RPU, PaperRow, Report};
use crate::table::{Table, grouped, wrap};

/// A design in a comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Candidate {
    /// What tells it from the others.
    pub name: String,
    /// Clocks from one frame to the next.
    pub cycles_per_frame: u32,
    /// Its area.
    pub report: Report,
}

/// The comparison for a terminal of `width` columns; 80 is enough.
#[must_use]
pub fn compare_text(candidates: &[Candidate], width: usize) -> String {
    let headings = candidates.first().map(|first| wrap(&heading(&first.report), width));
    headings.unwrap_or_default() + "\n" + &table(candidates).text(width)
}

/// The comparison as Markdown.
#[must_use]
pub fn compare_markdown(candidates: &[Candidate]) -> String {
    let headings = candidates.first().map(|first| heading(&first.report) + "\n");
    headings.unwrap_or_default() + "\n" + &table(candidates).markdown()
}

fn table(candidates: &[Candidate]) -> Table {
    let columns = ["low", "high", "memory", "LUT", "FF", "carry", "DSP", "cycles"];
    let mut rows: Vec<_> = candidates.iter().map(row).collect();
    rows.push(paper_row());
    Table {
        title: "Area of one RPU".to_owned(),
        header: std::iter::once("design").chain(columns).map(str::to_owned).collect(),
        rows,
        note: Some(
            "low, high: logic LUTs with and without small ones sharing a LUT. memory: two SRL16 are \
             one LUT, as Vivado packs them. LUT = high + memory. cycles: clocks from frame to frame."
                .to_owned(),
        ),
    }
}

fn row(candidate: &Candidate) -> Vec<String> {
    let area = &candidate.report.rpu;
    let figures = [
        area.lut_logic_low,
        area.lut_logic_high,
        area.lut_memory_packed,
        area.lut_total_packed,
        area.ff,
        area.carry,
        area.dsp,
        candidate.cycles_per_frame.into(),
    ];
    std::iter::once(candidate.name.clone()).chain(figures.map(grouped)).collect()
}

fn paper_row() -> Vec<String> {
    let PaperRow { lut, ff, lutram } = PAPER_RPU;
    let logic = grouped(lut - lutram);
    let cells = [String::new(), logic, grouped(lutram), grouped(lut), grouped(ff)];
    std::iter::once("paper (Vivado)".to_owned())
        .chain(cells)
        .chain([String::new(), String::new(), "64".to_owned()])
        .collect()
}
