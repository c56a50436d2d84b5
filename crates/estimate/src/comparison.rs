// SPDX-License-Identifier: MIT OR Apache-2.0
//! A comparison of several designs and the paper's in one table, one design per row.

use serde::Serialize;

use crate::device::{DeviceShare, FpgaDevice};
use crate::paper::{PAPER_RCM, PAPER_RPU};
use crate::render::{heading, ramb36};
use crate::report::AreaReport;
use crate::speed::FrameRate;
use foveate_output::number_text::grouped;
use foveate_output::report::{Report, ReportPart, ReportTable};

/// The clocks per frame of the paper's array.
const PAPER_CLOCKS_PER_FRAME: u64 = 64;

/// A comparison of designs.
#[derive(Clone, Debug, Serialize)]
pub struct DesignComparison {
    /// The version of the JSON format; it changes when a field changes its meaning or is removed.
    pub format_version: u32,
    /// The clock of the frame rates in MHz, if one was given; otherwise each design has its
    /// estimated one.
    pub clock_mhz: Option<f64>,
    /// The compared designs.
    pub candidates: Vec<ComparedDesign>,
    /// The designs that were left out, with the reasons.
    pub skipped: Vec<SkippedDesign>,
}

/// A design in a comparison.
#[derive(Clone, Debug, Serialize)]
pub struct ComparedDesign {
    /// The name of the design in the comparison.
    pub name: String,
    /// The area, paths, clock and frames per second of the design.
    pub report: AreaReport,
}

/// A design that was left out of the comparison.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SkippedDesign {
    /// The name of the design in the comparison.
    pub name: String,
    /// The reason why it was left out.
    pub reason: String,
}

impl DesignComparison {
    /// Makes an empty comparison at a clock in MHz, or at the designs' own clocks.
    #[must_use]
    pub fn new(clock_mhz: Option<f64>) -> Self {
        Self { format_version: 3, clock_mhz, candidates: Vec::new(), skipped: Vec::new() }
    }

    /// Adds a design.
    pub fn push(&mut self, name: String, report: AreaReport) {
        self.candidates.push(ComparedDesign { name, report: report.with_clock(self.clock_mhz) });
    }

    /// Returns the comparison as a table.
    #[must_use]
    pub fn table(&self) -> Report {
        let heading =
            self.candidates.first().map(|one| ReportPart::Paragraph(heading(&one.report)));
        let table = ReportPart::Table(self.candidate_table());
        Report(heading.into_iter().chain([table]).collect())
    }

    fn candidate_table(&self) -> ReportTable {
        let is_used =
            |count: fn(&AreaReport) -> u64| self.candidates.iter().any(|c| count(&c.report) > 0);
        let dsp = is_used(|report| report.whole_area().dsp);
        let bram = is_used(|report| report.whole_area().bram18);
        let extra_names = [dsp.then_some("DSP"), bram.then_some("RAMB36"), Some("device")];
        let header = HEADER.into_iter().chain(extra_names.into_iter().flatten());
        let extras = |dsps: String, brams: String| {
            dsp.then_some(dsps).into_iter().chain(bram.then_some(brams))
        };
        let mut rows = Vec::new();
        for candidate in &self.candidates {
            let whole = candidate.report.whole_area();
            let mut row = candidate_row(candidate);
            row.extend(extras(grouped(whole.dsp), ramb36(whole.bram18)));
            row.push(largest_share(&candidate.report.share));
            rows.push(row);
        }
        let mut paper_row = self.paper_row();
        paper_row.extend(extras(String::new(), String::new()));
        let lut = PAPER_RCM.lut * 10_000 / FpgaDevice::xcvu9p().lut;
        paper_row.push(format!("LUT {}.{:02}%", lut / 100, lut % 100));
        rows.push(paper_row);
        let note = format!(
            "low, high: logic LUTs of one RPU or lane, with and without small ones sharing a \
             LUT. mem: LUTs as memory, two SRL16 in one, as Vivado packs them. LUT = high + \
             mem. levels: of the longest path, from and to registers, memories and ports. \
             cycles: clocks from frame to frame. MHz: {}. frames/s: at that clock. RCM, and \
             the columns right of it: all regions and the logic that they share{}. device: the \
             largest share of an {}.",
            match self.clock_mhz {
                Some(_) => "the clock as it was given",
                None => "the clock that is estimated from the netlist, and its range",
            },
            if self.candidates.iter().any(|one| one.report.bus.is_some()) {
                ", and the AXI interface"
            } else {
                ""
            },
            FpgaDevice::xcvu9p().name,
        );
        let skipped = self.skipped.iter();
        let skipped = skipped.map(|one| format!("Without {}: {}.", one.name, one.reason));
        let table = ReportTable::new(header, rows)
            .described("Area, speed and logic levels", std::iter::once(note).chain(skipped));
        ReportTable { is_stacked: true, ..table }
    }

    fn paper_row(&self) -> Vec<String> {
        let texts = ["paper (Vivado)", ""].map(str::to_owned);
        let unit =
            [PAPER_RPU.lut - PAPER_RPU.lutram, PAPER_RPU.lutram, PAPER_RPU.lut, PAPER_RPU.ff];
        // The paper does not state its clock.
        let speed =
            self.clock_mhz.map(|mhz| FrameRate::at_given_clock(mhz, PAPER_CLOCKS_PER_FRAME));
        let array = [PAPER_RCM.lut, PAPER_RCM.lutram, PAPER_RCM.ff];
        texts
            .into_iter()
            .chain(unit.map(grouped))
            .chain([String::new()])
            .chain([grouped(PAPER_CLOCKS_PER_FRAME)])
            .chain(clock_and_rate(speed.as_ref()))
            .chain(array.map(grouped))
            .collect()
    }
}

const HEADER: [&str; 13] = [
    "design", "low", "high", "mem", "LUT", "FF", "levels", "cycles", "MHz", "frames/s", "RCM LUT",
    "RCM mem", "RCM FF",
];

/// Returns the clock and the frames per second at that clock. Both texts are empty if no clock is
/// known.
fn clock_and_rate(speed: Option<&FrameRate>) -> [String; 2] {
    speed.map_or_else(Default::default, |speed| [speed.clock_text(), speed.rate_text()])
}

fn candidate_row(candidate: &ComparedDesign) -> Vec<String> {
    let AreaReport { rpu, clocks_per_frame, speed, .. } = &candidate.report;
    let whole = candidate.report.whole_area();
    let unit = [
        rpu.lut_logic_low,
        rpu.lut_logic_high,
        rpu.lut_memory_packed,
        rpu.lut_total_packed,
        rpu.ff,
        candidate.report.levels().into(),
        *clocks_per_frame,
    ];
    let array = [whole.lut_total_packed, whole.lut_memory_packed, whole.ff];
    std::iter::once(candidate.name.clone())
        .chain(unit.map(grouped))
        .chain(clock_and_rate(speed.as_ref()))
        .chain(array.map(grouped))
        .collect()
}

fn largest_share(share: &DeviceShare) -> String {
    let shares = [
        ("LUT", share.lut),
        ("mem", share.lut_memory),
        ("FF", share.ff),
        ("DSP", share.dsp),
        ("RAMB36", share.bram),
    ];
    let largest = shares.into_iter().reduce(|a, b| if b.1 > a.1 { b } else { a });
    let (name, share) = largest.expect("there are five");
    format!("{name} {share:.2}%")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::example;

    fn comparison() -> DesignComparison {
        comparison_at(None)
    }

    fn comparison_at(clock_mhz: Option<f64>) -> DesignComparison {
        let mut comparison = DesignComparison::new(clock_mhz);
        comparison.push("pipelined edge".to_owned(), example(784));
        comparison
            .skipped
            .push(SkippedDesign { name: "serial".into(), reason: "it is not there".into() });
        comparison
    }

    #[test]
    fn one_table_fits_any_terminal() {
        for width in [60, 80, 200] {
            let text = comparison().table().text(width);
            let widest = text.lines().map(|line| line.chars().count()).max();
            assert!(widest <= Some(width), "{text}");
            for part in [
                "60 (48 to 80)",
                "937,500",
                "143,472",
                "119,171",
                "LUT 12.13%",
                "Without serial: it is not there.",
            ] {
                assert!(text.contains(part), "{part} in\n{text}");
            }
            let tables = text.matches("paper (Vivado)").count();
            assert_eq!(tables == 1, width == 200, "{text}");
        }
    }

    /// The rates are for 64 clocks at 100 MHz. Without a given clock the paper has no rate, because
    /// it does not state its clock.
    #[test]
    fn a_given_clock_applies_to_all_rates() {
        let rates =
            |clock| comparison_at(clock).table().markdown().matches("| 100 | 1,562,500 |").count();
        assert_eq!([rates(Some(100.0)), rates(None)], [2, 0]);
        let markdown = comparison().table().markdown();
        assert!(markdown.contains("| 64 |  |  | 143,472 |"), "{markdown}");
    }

    #[test]
    fn block_ram_has_a_column_where_there_is_some() {
        let markdown = comparison().table().markdown();
        assert!(
            markdown.contains("| RAMB36 | device |") && markdown.contains("| 392 |"),
            "{markdown}"
        );
        assert!(!markdown.contains("DSP |"), "{markdown}");
    }
}
