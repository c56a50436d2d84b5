// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report on a design in the cells of a library ([`SiliconReport`]), with its text for a
//! terminal and as Markdown.

use super::cell_totals::CellTotals;
use super::leaves::SiliconLeaf;
use super::mapping::MemoryFigures;
use super::timing::SiliconPath;
use crate::speed::count_to_f64;
use foveate_output::number_text::{grouped, real_number};
use foveate_output::report::{Report, ReportPart, ReportTable};
use foveate_tools::ToolRecord;
use serde::{Deserialize, Serialize};

/// The version of the JSON report. It grows when a field changes its meaning or is removed.
pub const SILICON_FORMAT_VERSION: u32 = 1;

/// The parts of a chip that no figure includes.
pub const NOT_INCLUDED: &str = "Not included: wires, the clock tree, buffers between modules, other corners, pixels and converters. \
     So area and leakage are lower bounds, and the clock is an upper bound.";

/// The area, the longest path and the leakage of a design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SiliconReport {
    /// The version of the format, [`SILICON_FORMAT_VERSION`].
    pub format_version: u32,
    /// The hash of the RTL; see `sources_sha256` of the toolchain.
    pub rtl_sha256: String,
    /// The library of cells.
    pub library: LibraryFigures,
    /// The tools that mapped and timed the design.
    pub tools: Vec<ToolRecord>,
    /// True if gates were sized and buffers were added for their loads; false if the library has no
    /// buffer.
    pub is_sized: bool,
    /// The number of regions.
    pub regions: u64,
    /// The pixels of a region along one side.
    pub region_size: u32,
    /// The unit of which the array has many: an RPU, a lane or a core.
    pub unit: UnitFigures,
    /// The logic that the units share.
    pub shared: CellTotals,
    /// All cells of the array, without memories that are not mapped.
    pub array: CellTotals,
    /// The modules of the unit, or of the array where that says more, each mapped by itself. Their
    /// areas do not add up to that of the unit, in which logic is optimized across modules.
    pub leaves: Vec<SiliconLeaf>,
    /// The largest memory in bits that becomes flip-flops.
    pub memory_limit: u64,
    /// The larger memories.
    pub memories: Vec<MemoryFigures>,
    /// The sums of the larger memories.
    pub memory: MemoryTotals,
    /// The longest path.
    pub path: SiliconPath,
    /// The leakage of the array in nanowatts, without memories that are not mapped.
    pub leakage_nw: f64,
    /// The frames per second at the highest clock.
    pub frames_per_second: f64,
}

/// The library of cells of a report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LibraryFigures {
    /// The name of the library.
    pub name: String,
    /// The hash of its file, after decompression.
    pub sha256: String,
    /// The nominal voltage in volts, if the library has one.
    pub voltage: Option<f64>,
    /// The area of a gate equivalent, the smallest NAND of two inputs, in square micrometres.
    pub gate_area_um2: f64,
}

/// The figures of the unit of an array.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnitFigures {
    /// The name of the module for people.
    pub name: String,
    /// The number of instances.
    pub count: u64,
    /// The cells of one instance.
    pub cells: CellTotals,
}

/// The sums of the memories that are not mapped to cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MemoryTotals {
    /// The bits of all memories.
    pub bits: u64,
    /// The bits of the memories for which no macro fits.
    pub bits_without_macro: u64,
    /// The number of macros.
    pub macros: u64,
    /// The area of the macros in square micrometres.
    pub macro_area_um2: f64,
}

impl MemoryTotals {
    pub(super) fn of_memories(memories: &[MemoryFigures]) -> Self {
        let mut total = Self::default();
        for memory in memories {
            total.bits += memory.bits();
            match &memory.macros {
                None => total.bits_without_macro += memory.bits(),
                Some(choice) => {
                    total.macros += choice.count * memory.count;
                    total.macro_area_um2 += choice.area_um2 * count_to_f64(memory.count);
                }
            }
        }
        total
    }
}

impl SiliconReport {
    /// Returns the area of cells and macros in square millimetres.
    #[must_use]
    pub fn area_mm2(&self) -> f64 {
        (self.array.area_um2 + self.memory.macro_area_um2) / 1e6
    }

    /// Returns an area in gate equivalents.
    #[must_use]
    pub fn gates(&self, area_um2: f64) -> f64 {
        area_um2 / self.library.gate_area_um2
    }

    /// Returns the side in micrometres of a pixel under which the circuit of its region fits: the N
    /// x N pixels of a region together have as much area as a region's share of cells and macros.
    #[must_use]
    pub fn pixel_pitch_um(&self) -> f64 {
        let of_region = self.area_mm2() * 1e6 / count_to_f64(self.regions);
        of_region.sqrt() / f64::from(self.region_size)
    }

    /// Returns the report as tables and sentences; 80 columns of a terminal are enough.
    #[must_use]
    pub fn tables(&self) -> Report {
        let memories = (!self.memories.is_empty()).then(|| memory_table(self));
        let tables = [area_table(self)].into_iter().chain(memories).map(ReportPart::Table);
        let leaves = (!self.leaves.is_empty()).then(|| ReportPart::Table(leaf_table(self)));
        Report(tables.chain([ReportPart::Sentences(sentences(self))]).chain(leaves).collect())
    }
}

const COLUMNS: [&str; 7] = ["module", "count", "cells", "FF", "um2", "FF %", "gates"];
const MEMORY_COLUMNS: [&str; 6] =
    ["memory", "count", "words", "bits", "macros of one", "um2 of one"];

fn leaf_table(report: &SiliconReport) -> ReportTable {
    let of = report.leaves.first().map_or("", |leaf| leaf.module.as_str());
    let rows = report.leaves.iter().map(|leaf| {
        let name = std::iter::once(leaf.module.as_str());
        let name: Vec<_> = name.chain(leaf.parameters.iter().map(String::as_str)).collect();
        area_row(report, &name.join(" "), leaf.instances, leaf.cells)
    });
    let note = "Figures are for one instance without the modules inside it. They do not add up to those above, where \
         logic is optimized across modules.";
    ReportTable::new(COLUMNS, rows)
        .described(format!("Modules of {of}, each mapped apart"), Some(note.to_owned()))
}

fn area_table(report: &SiliconReport) -> ReportTable {
    let volts = report.library.voltage.map_or_else(String::new, |volts| format!(" at {volts} V"));
    let unit = &report.unit;
    let mut rows = vec![area_row(report, &unit.name, unit.count, unit.cells)];
    if report.shared.cells > 0 {
        rows.push(area_row(report, "shared logic", 1, report.shared));
    }
    rows.push(area_row(report, "array", 1, report.array));
    let note = format!(
        "um2: the area of the cells. FF %: the part of it that is flip-flops. gates: the area in NANDs of two \
         inputs, of {} um2 each.",
        real_number(report.library.gate_area_um2, 2)
    );
    ReportTable::new(COLUMNS, rows)
        .described(format!("Cells of {}{volts}", report.library.name), Some(note))
}

fn area_row(report: &SiliconReport, name: &str, count: u64, cells: CellTotals) -> Vec<String> {
    let share = 100.0 * cells.flip_flop_area_um2 / cells.area_um2.max(f64::MIN_POSITIVE);
    vec![
        name.to_owned(),
        grouped(count),
        grouped(cells.cells),
        grouped(cells.flip_flops),
        real_number(cells.area_um2, 0),
        format!("{share:.0}"),
        real_number(report.gates(cells.area_um2), 0),
    ]
}

fn memory_table(report: &SiliconReport) -> ReportTable {
    let limit = grouped(report.memory_limit);
    let without_macros = match report.memory.macros {
        0 => "; no macro holds them, so their area is not in any figure",
        _ => "",
    };
    ReportTable::new(MEMORY_COLUMNS, report.memories.iter().map(memory_row))
        .described(format!("Memories of more than {limit} bits{without_macros}"), None)
}

fn memory_row(memory: &MemoryFigures) -> Vec<String> {
    let (macros, area) = match &memory.macros {
        None => ("-".to_owned(), "-".to_owned()),
        Some(choice) => {
            (format!("{} {}", choice.count, choice.name), real_number(choice.area_um2, 0))
        }
    };
    let numbers = [memory.count, memory.words, memory.words * memory.width].map(grouped);
    let [count, words, bits] = numbers;
    vec![memory.name.clone(), count, words, bits, macros, area]
}

fn sentences(report: &SiliconReport) -> Vec<String> {
    let path = &report.path;
    let memory = &report.memory;
    let mut all = vec![
        format!(
            "The array takes {} mm2{}. The circuit of each of its {} regions of {}x{} pixels fits under pixels of {} um.",
            real_number(report.area_mm2(), 3),
            if memory.macros > 0 {
                format!(
                    ", {} of it in {} macros",
                    real_number(memory.macro_area_um2 / 1e6, 3),
                    grouped(memory.macros)
                )
            } else {
                String::new()
            },
            grouped(report.regions),
            report.region_size,
            report.region_size,
            real_number(report.pixel_pitch_um(), 2),
        ),
        format!(
            "Longest path: {} ns over {} cells, from {} to {}. So the highest clock is {} MHz, for {} frames/s.",
            real_number(path.ns, 2),
            path.cells,
            path.from,
            path.to,
            real_number(path.mhz, 1),
            real_number(report.frames_per_second, 1),
        ),
        format!("Leakage of the array: {} uW.", real_number(report.leakage_nw / 1000.0, 3)),
    ];
    if memory.bits_without_macro > 0 {
        all.push(format!(
            "{} bits of memory have no macro, so neither their area nor their leakage is counted, and paths end at \
             their ports.",
            grouped(memory.bits_without_macro)
        ));
    }
    if !report.is_sized {
        all.push("The library has no buffer, so gates were not sized for their loads.".to_owned());
    }
    all.push(NOT_INCLUDED.to_owned());
    let tools = report.tools.iter().map(|tool| {
        let version = tool.version.split(" (").next().unwrap_or(&tool.version);
        let name =
            if version.starts_with(&tool.name) { String::new() } else { format!("{} ", tool.name) };
        format!("{name}{version} ({})", tool.flags)
    });
    all.push(format!("Tools: {}.", tools.collect::<Vec<_>>().join("; ")));
    all
}
