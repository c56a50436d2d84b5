// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps a design to a library and times it.

use foveate_design::Design;
use foveate_emit::{AXI_CLOCK, Top};
use foveate_toolchain::{Cache, SynthesisJob, Toolchain, sources_sha256};

use super::cell_totals::CellTotals;
use super::error::SiliconError;
use super::leaves::list_leaves;
use super::library::{CellRole, LibertyLibrary};
use super::mapping::{MappedArray, map_array, map_leaves};
use super::memory_plan::plan_memory;
use super::net_names::source_name;
use super::report::{
    LibraryFigures, MemoryTotals, SILICON_FORMAT_VERSION, SiliconReport, UnitFigures,
};
use super::timing::{ModuleTiming, SiliconPath, time_module};
use super::unit_instances::{LONE_UNIT, with_lone_unit, with_units};
use crate::EstimateJob;
use crate::speed::clocks_as_float;

/// The clock port of every array.
const ARRAY_CLOCK: &str = "clk_i";

/// A design to map to the cells of a library.
#[derive(Clone, Debug)]
pub struct SiliconJob {
    /// The array, its unit, and the number of each.
    pub design: EstimateJob,
    /// The pixels of a region along one side.
    pub region_size: u32,
    /// The module whose leaves are listed.
    pub leaves_of: String,
    /// The largest memory in bits that becomes flip-flops.
    pub memory_limit: u64,
}

impl SiliconJob {
    /// Makes the job of a design's freshly generated Verilog.
    #[must_use]
    pub fn for_design(design: &Design, memory_limit: u64) -> Self {
        Self {
            design: EstimateJob::for_design(design, Top::Rcm),
            region_size: design.region_size(),
            leaves_of: design.unit().area_module.to_owned(),
            memory_limit,
        }
    }
}

/// Maps a design to `library` with Yosys, and times it with OpenSTA. Memories that are not mapped get
/// macros from `macros`.
///
/// # Errors
/// Fails if a tool is missing or fails, if the library lacks a cell that the design needs or the area
/// of one, or if cells and macros have different voltages.
pub fn map_to_silicon(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &SiliconJob,
    (library, macros): (&LibertyLibrary, &[LibertyLibrary]),
) -> Result<SiliconReport, SiliconError> {
    check_libraries(library, macros)?;
    let synthesis = job.design.top_synthesis();
    let clock = if job.design.bus.is_some() { AXI_CLOCK } else { ARRAY_CLOCK };
    let gate_area_um2 = library.gate_area().ok_or_else(|| SiliconError::MissingCell {
        library: library.name.clone(),
        missing: "NAND of two inputs with an area",
    })?;
    let mut roles = library.cells.values().map(|cell| cell.role);
    if !roles.any(|role| role == CellRole::FlipFlop) {
        let (library, missing) = (library.name.clone(), "flip-flop");
        return Err(SiliconError::MissingCell { library, missing });
    }
    let mapped = map_array(toolchain, cache, synthesis, library, job.memory_limit)?;
    let kinds = unit_kinds(&mapped, (job, synthesis))?;
    let (unit, shared) = unit_and_shared_cells(&mapped, &kinds, &synthesis.array, library)?;
    let within = (job.leaves_of.as_str(), job.memory_limit);
    let leaves = map_leaves(toolchain, cache, &job.design.synthesis, library, within)?;
    let time = |verilog: &str, top: &str, clock: &str| {
        time_module(toolchain, cache, (verilog, top, clock), library)
    };
    let one_unit = with_units(&mapped.verilog, &kinds, Some(&kinds[0]));
    let ModuleTiming { tool: timer, path, leakage_nw } = time(&one_unit, &synthesis.array, clock)?;
    let mut paths = vec![(path, synthesis.array.as_str())];
    if !mapped.memories.is_empty() {
        // The ports of memories inside a unit are not connected in the array.
        let alone = with_lone_unit(&mapped.verilog, &kinds[0]);
        paths.push((time(&alone, LONE_UNIT, ARRAY_CLOCK)?.path, kinds[0].as_str()));
    }
    let named = paths.into_iter().filter_map(|(path, top)| {
        let path = path?;
        let [from, to] = [&path.from, &path.to].map(|end| source_name(&mapped.json, top, end));
        Some(SiliconPath { from, to, ..path })
    });
    let path = named.max_by(|a, b| a.ns.total_cmp(&b.ns)).ok_or_else(|| SiliconError::Timing {
        reason: "there is no path between registers or ports".to_owned(),
    })?;
    let units = job.design.units;
    let shared_leakage_nw = match shared.cells {
        0 => 0.0,
        _ => time(&with_units(&mapped.verilog, &kinds, None), &synthesis.array, clock)?.leakage_nw,
    };
    #[allow(clippy::cast_precision_loss, reason = "there are fewer than 2^53 units")]
    let leakage_nw = shared_leakage_nw + (leakage_nw - shared_leakage_nw) * units as f64;
    let memories: Vec<_> =
        mapped.memories.iter().map(|memory| plan_memory(memory, macros)).collect();
    let frames_per_second = path.mhz * 1e6 / clocks_as_float(job.design.clocks_per_frame.max(1));
    Ok(SiliconReport {
        format_version: SILICON_FORMAT_VERSION,
        rtl_sha256: sources_sha256(&synthesis.sources),
        library: LibraryFigures {
            name: library.name.clone(),
            sha256: library.sha256.clone(),
            voltage: library.voltage,
            gate_area_um2,
        },
        tools: vec![mapped.tool, timer],
        is_sized: mapped.is_sized,
        regions: job.design.regions,
        region_size: job.region_size,
        unit: UnitFigures { name: job.design.unit_name.clone(), count: units, cells: unit },
        shared,
        array: shared.plus(unit, units),
        leaves: list_leaves(&leaves, library, &job.leaves_of)?,
        memory_limit: job.memory_limit,
        memory: MemoryTotals::of_memories(&memories),
        memories,
        path,
        leakage_nw,
        frames_per_second,
    })
}

/// Returns the modules of the netlist that are units, the most frequent first.
fn unit_kinds(
    mapped: &MappedArray,
    (job, synthesis): (&SiliconJob, &SynthesisJob),
) -> Result<Vec<String>, SiliconError> {
    let kinds = job.design.units(&mapped.netlist, synthesis);
    kinds.map_err(|error| SiliconError::Netlist { reason: error.to_string() })
}

/// Returns the cells of one unit, of the most frequent kind, and those that the units share.
fn unit_and_shared_cells(
    mapped: &MappedArray,
    kinds: &[String],
    array: &str,
    library: &LibertyLibrary,
) -> Result<(CellTotals, CellTotals), SiliconError> {
    let names: Vec<&str> = kinds.iter().map(String::as_str).collect();
    let unit = CellTotals::of_module(&mapped.netlist, library, names[0], &[])?;
    if names[0] == array {
        return Ok((unit, CellTotals::default()));
    }
    let shared = CellTotals::of_module(&mapped.netlist, library, array, &names)?;
    Ok((unit, shared))
}

/// Refuses macros that are none, or have another voltage than the cells.
fn check_libraries(
    library: &LibertyLibrary,
    macros: &[LibertyLibrary],
) -> Result<(), SiliconError> {
    let voltage = |library: &LibertyLibrary| match library.voltage {
        Some(volts) => format!("{volts} V"),
        None => "an unknown voltage".to_owned(),
    };
    for own in macros {
        if own.memories().next().is_none() {
            return Err(SiliconError::NoMemory { path: own.path.clone() });
        }
        if own.voltage.is_none() || own.voltage != library.voltage {
            return Err(SiliconError::Voltages {
                first: library.name.clone(),
                first_voltage: voltage(library),
                second: own.name.clone(),
                second_voltage: voltage(own),
            });
        }
    }
    Ok(())
}
