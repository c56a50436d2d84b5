// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report in tables, for people.

mod paper;

use crate::area::Area;
use crate::logic_levels::LogicPath;
use crate::report::{AreaReport, LeafArea, LongestPaths};
use foveate_output::number_text::grouped;
use foveate_output::report::{Report, ReportPart, ReportTable};
use foveate_tools::ToolRecord;
use paper::paper_table;

/// The name of a core on AXI in tables.
const AXI_CORE_NAME: &str = "RCM on AXI";

const COLUMNS: [&str; 9] =
    ["module", "low", "high", "memory", "LUT", "FF", "carry", "DSP", "RAMB36"];

impl AreaReport {
    /// Returns the report as tables; 80 columns of a terminal are enough.
    #[must_use]
    pub fn tables(&self) -> Report {
        let leaves = (!self.leaves.is_empty()).then(|| leaf_table(self));
        let further = [paper_table(self), leaves].into_iter().flatten();
        let tables = [area_table(self), path_table(self)].into_iter().chain(further);
        let heading = ReportPart::Paragraph(heading(self));
        Report(std::iter::once(heading).chain(tables.map(ReportPart::Table)).collect())
    }
}

pub(crate) fn heading(report: &AreaReport) -> String {
    let ToolRecord { version, flags, .. } = &report.tool;
    let version = version.split(" (").next().unwrap_or(version);
    format!("Yosys estimate ({version}): {flags}")
}

fn area_table(report: &AreaReport) -> ReportTable {
    let mut rows = area_rows(&report.unit, &report.rpu);
    rows.extend(area_rows("RCM", &report.rcm));
    rows.push(area_row("  glue only", &report.rcm_glue));
    let mut note =
        "low, high: logic LUTs with and without small ones sharing a LUT. LUT = high + memory. \
                    carry: units of CARRY4. RAMB36: block RAM; half of one is a RAMB18."
            .to_owned();
    if let Some(bus) = &report.bus {
        rows.extend(bus.parts.iter().map(|part| area_row(&part.name, &part.area)));
        rows.extend(area_rows(AXI_CORE_NAME, &bus.whole));
        if !bus.parts.is_empty() {
            note += &format!(
                " {AXI_CORE_NAME}: all of it, module {}. The parts between it and the RCM are synthesized apart, \
                 and do not add up to it: logic is optimized across modules.",
                bus.module
            );
        }
    }
    rows.push(share_row(report));
    ReportTable::new(COLUMNS, rows).described(area_title(report), Some(note))
}

fn area_title(report: &AreaReport) -> String {
    let AreaReport { regions, unit, units, .. } = report;
    if units == regions {
        format!("Area of {} regions, one {unit} each", grouped(*regions))
    } else if *units == 1 {
        format!("Area of {} regions, one {unit} for all", grouped(*regions))
    } else {
        format!("Area of {} regions, {} {unit}s", grouped(*regions), grouped(*units))
    }
}

fn path_table(report: &AreaReport) -> ReportTable {
    let LongestPaths { rpu, rcm } = &report.paths;
    let row = |name: &str, path: &LogicPath| {
        vec![name.to_owned(), path.levels.to_string(), path.carry4.to_string()]
    };
    let description =
        |path: &LogicPath| format!("from {} by {} to {}", path.from, path_cells(path), path.to);
    let mut note = format!("{}: {}. ", report.unit, description(rpu));
    if rcm != rpu {
        note += &format!("RCM: {}. ", description(rcm));
    }
    let mut rows = vec![row(&report.unit, rpu), row("RCM", rcm)];
    if let Some(bus) = &report.bus {
        note += &format!("{AXI_CORE_NAME}: {}. ", description(&bus.path));
        rows.push(row(AXI_CORE_NAME, &bus.path));
    }
    if let Some(clock) = &report.clock {
        note += &format!(
            "Estimated clock of the {}: {}, by Yosys' cell models, which are of the 7 series. ",
            design_name(report),
            clock.text()
        );
    }
    if let Some(speed) = &report.speed {
        let clocks = grouped(report.clocks_per_frame);
        let rate = match speed.estimated {
            true => format!("{} frames/s at that clock", speed.rate_with_range()),
            false => speed.text(),
        };
        note += &format!("A frame takes {clocks} clocks: {rate}. ");
    }
    note += "A LUT, a read of distributed RAM and a whole carry chain are a level each; CARRY4: blocks \
             of four bits in chains.";
    let title = "Longest path in logic levels, from and to registers, memories and ports";
    ReportTable::new(["module", "levels", "CARRY4"], rows).described(title, Some(note))
}

/// Returns the name of the whole design.
fn design_name(report: &AreaReport) -> &'static str {
    if report.bus.is_some() { AXI_CORE_NAME } else { "RCM" }
}

/// Returns the cells of a path as text; consecutive carry blocks form one word.
fn path_cells(path: &LogicPath) -> String {
    let runs = path.through.chunk_by(|a, b| a == b && a.starts_with("CARRY"));
    let names = runs.map(|run| match run {
        [one] => one.clone(),
        run => format!("{}x{}", run[0], run.len()),
    });
    let text = names.collect::<Vec<_>>().join(" ");
    if text.is_empty() { "a wire".to_owned() } else { text }
}

/// Returns the row of an area, and a second one if shift registers can be packed.
fn area_rows(name: &str, area: &Area) -> Vec<Vec<String>> {
    let mut rows = vec![area_row(name, area)];
    if area.lut_memory_packed != area.lut_memory {
        let packed =
            Area { lut_memory: area.lut_memory_packed, lut_total: area.lut_total_packed, ..*area };
        rows.push(area_row("  SRL16 paired", &packed));
    }
    rows
}

fn area_row(name: &str, area: &Area) -> Vec<String> {
    let figures = [
        area.lut_logic_low,
        area.lut_logic_high,
        area.lut_memory,
        area.lut_total,
        area.ff,
        area.carry,
        area.dsp,
    ];
    let mut row = vec![name.to_owned()];
    row.extend(figures.map(grouped));
    row.push(ramb36(area.bram18));
    row
}

fn share_row(report: &AreaReport) -> Vec<String> {
    let percent = |value: f64| format!("{value:.2}%");
    let share = &report.share;
    vec![
        format!("  of {}", report.device.name),
        String::new(),
        String::new(),
        percent(share.lut_memory),
        percent(share.lut),
        percent(share.ff),
        String::new(),
        percent(share.dsp),
        percent(share.bram),
    ]
}

fn leaf_table(report: &AreaReport) -> ReportTable {
    // The first row is the module whose leaves are listed.
    let of_array =
        report.bus.is_some() || report.leaves.first().is_some_and(|leaf| leaf.module == "rcm");
    let whole = if of_array { design_name(report) } else { report.unit.as_str() };
    let title = if of_array { format!("the {whole}") } else { format!("one {whole}") };
    let columns = ["module", "count", "low", "high", "memory", "LUT", "FF", "carry", "RAMB36"];
    let note = format!(
        "Figures are for one instance without the modules inside it. They do not add up to the \
         {whole} above, where logic is optimized across modules."
    );
    ReportTable::new(columns, report.leaves.iter().map(leaf_row))
        .described(format!("Modules of {title}, each synthesized apart"), Some(note))
}

fn leaf_row(leaf: &LeafArea) -> Vec<String> {
    let name = match leaf.parameters.as_slice() {
        [] => leaf.module.clone(),
        parameters => format!("{} {}", leaf.module, parameters.join(" ")),
    };
    let mut row = vec![name, grouped(leaf.instances)];
    // Without the column for DSP blocks, the names fit into 80 columns.
    let figures = COLUMNS.into_iter().zip(area_row("", &leaf.area)).skip(1);
    row.extend(figures.filter(|(column, _)| *column != "DSP").map(|(_, figure)| figure));
    row
}

/// Returns block RAM in units of `RAMB36`, of which a `RAMB18` is half, as in every table.
#[must_use]
pub fn ramb36(bram18: u64) -> String {
    let half = if bram18 & 1 == 1 { ".5" } else { "" };
    grouped(bram18 / 2) + half
}

#[cfg(test)]
mod tests {
    use crate::report::tests::{bus_example, example, serial_example};

    #[test]
    fn text_fits_the_terminal() {
        let text = example(784).tables().text(80);
        let widest = text.lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(80), "{text}");
        for part in [
            "Yosys 0.23",
            "0.87x",
            "0.83x",
            "143,472",
            "125,443",
            "10.61%",
            "SRL16 paired",
            "LUT6 CARRY4x2",
        ] {
            assert!(text.contains(part), "{part} in\n{text}");
        }
    }

    #[test]
    fn frames_per_second_stand_beside_their_clock() {
        let text = |mhz| example(784).with_clock(mhz).tables().text(1000);
        let estimated = "60 MHz (48 to 80), by Yosys' cell models, which are of the 7 series. A frame takes \
                   64 clocks: 937,500 (750,000 to 1,250,000) frames/s at that clock. ";
        assert!(text(None).contains(estimated), "{}", text(None));
        let given = "A frame takes 64 clocks: 1,562,500 frames/s at 100 MHz. ";
        assert!(text(Some(100.0)).contains(given), "{}", text(Some(100.0)));
    }

    #[test]
    fn the_paper_is_compared_only_with_an_array_of_its_size() {
        assert!(!example(4).tables().text(80).contains("143,472"));
    }

    #[test]
    fn markdown_has_four_tables() {
        let text = example(784).tables().markdown();
        assert_eq!(text.matches("| --- |").count(), 4);
        assert!(text.contains("| RPU, Yosys estimate | 160 | 0.87x |"), "{text}");
        assert!(text.contains("| median WIDTH=8 SIDE=8 | 2 |"), "{text}");
    }

    #[test]
    fn a_core_on_a_bus_has_rows_for_the_parts_around_the_array() {
        let text = bus_example().tables().text(200);
        let rows: Vec<&str> =
            text.lines().map(|line| line.split("  ").next().unwrap_or("")).collect();
        let row_index = |name: &str| {
            rows.iter().position(|row| *row == name).unwrap_or_else(|| panic!("{name}: {text}"))
        };
        assert!(
            row_index("RCM") < row_index("registers")
                && row_index("registers") < row_index("RCM on AXI"),
            "{text}"
        );
        for part in [
            "Modules of the RCM on AXI, each",
            " 205 ",
            " 1,404 ",
            "  of XCVU9P                 0.00%  0.12%",
            "Estimated clock of the RCM on AXI: 60",
            "RCM on AXI       7",
        ] {
            assert!(text.contains(part), "{part} in\n{text}");
        }
        let widest = bus_example().tables().text(80).lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(80));
        assert!(!example(4).tables().text(80).contains("AXI"));
    }

    #[test]
    fn tables_of_a_serial_array_name_lanes() {
        let mut report = serial_example(784, 21);
        report.leaves[0].module = "rcm".into();
        let text = report.tables().text(200);
        for part in [
            "Area of 784 regions, 21 lanes",
            "\nlane ",
            "lane: from",
            "RPU, paper",
            "lane, Yosys estimate",
            "Modules of the RCM,",
            "add up to the RCM above",
        ] {
            assert!(text.contains(part), "{part} in\n{text}");
        }
        assert_eq!(text.matches("RPU").count(), 1, "only the paper's:\n{text}");
        let one = serial_example(784, 1).tables().text(200);
        assert!(one.contains("Area of 784 regions, one lane for all"), "{one}");
        assert!(one.contains("RCM, paper") && !one.contains("RPU"), "{one}");
        assert!(!serial_example(12, 1).tables().text(200).contains("paper"), "no array like it");
        let each = serial_example(784, 784).tables().text(200);
        assert!(each.contains("Area of 784 regions, one lane each"), "{each}");
        assert!(each.contains("Modules of one lane,"), "{each}");
    }
}
