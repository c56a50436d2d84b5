// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's table with the design's figures.

use crate::area::Area;
use crate::paper::PaperComparison;
use crate::report::AreaReport;
use foveate_output::number_text::grouped;
use foveate_output::report::ReportTable;

/// Returns the table; `None` if the paper has no comparable module.
pub(super) fn paper_table(report: &AreaReport) -> Option<ReportTable> {
    let mut rows = Vec::new();
    // A unit for all regions is comparable to the paper's array, but not to one RPU.
    if report.units > 1 || report.regions == 1 {
        rows = paper_rows("RPU", &report.unit, &report.rpu, &report.paper.rpu);
    }
    if let Some(comparison) = &report.paper.rcm {
        rows.extend(paper_rows("RCM", "RCM", &report.rcm, comparison));
    }
    if rows.is_empty() {
        return None;
    }
    let columns = ["", "LUT", "ratio", "FF", "ratio", "LUTRAM", "ratio"];
    let title = "Beside the paper's table (Vivado, 8x8 regions, 224x224 frames)";
    Some(ReportTable::new(columns, rows).described(title, None))
}

/// Returns the row of the paper's module, and those of the design's module.
fn paper_rows(
    paper_name: &str,
    name: &str,
    area: &Area,
    comparison: &PaperComparison,
) -> Vec<Vec<String>> {
    let PaperComparison { paper, ratio } = comparison;
    let row = |name: String, cells: [(u64, Option<f64>); 3]| {
        let pairs = cells.into_iter().flat_map(|(value, ratio)| {
            [grouped(value), ratio.map_or_else(String::new, |ratio| format!("{ratio:.2}x"))]
        });
        std::iter::once(name).chain(pairs).collect()
    };
    let mut rows = vec![
        row(
            format!("{paper_name}, paper"),
            [(paper.lut, None), (paper.ff, None), (paper.lutram, None)],
        ),
        row(
            format!("{name}, Yosys estimate"),
            [
                (area.lut_total, Some(ratio.lut_total)),
                (area.ff, Some(ratio.ff)),
                (area.lut_memory, Some(ratio.lut_memory)),
            ],
        ),
    ];
    if area.lut_memory_packed != area.lut_memory {
        rows.push(row(
            "  SRL16 paired".to_owned(),
            [
                (area.lut_total_packed, Some(ratio.lut_total_packed)),
                (area.ff, Some(ratio.ff)),
                (area.lut_memory_packed, Some(ratio.lut_memory_packed)),
            ],
        ));
    }
    rows
}
