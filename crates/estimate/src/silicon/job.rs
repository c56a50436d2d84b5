// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps a design to a library and times it.

use foveate_design::Design;
use foveate_emit::{AXI_CLOCK, Top};
use foveate_tools::{Cache, Toolchain, sources_sha256};

use super::cell_totals::CellTotals;
use super::error::SiliconError;
use super::leaves::list_leaves;
use super::library::{CellRole, LibertyLibrary};
use super::mapping::{MappedArray, map_array, map_leaves, plan_memory};
use super::report::{
    LibraryFigures, MemoryTotals, SILICON_FORMAT_VERSION, SiliconReport, UnitFigures,
};
use super::timing::{ARRAY_CLOCK, ArrayTiming, TimedArray, time_array};
use crate::EstimateJob;
use crate::speed::count_to_f64;

/// A design to map to the cells of a library.
#[derive(Clone, Debug)]
pub struct SiliconJob {
    /// The array, its unit, and the number of each.
    pub design: EstimateJob,
    /// The pixels of a region along one side.
    pub region_size: u32,
    /// The module whose leaves are listed, if they are.
    pub leaves_of: Option<String>,
    /// The largest memory in bits that becomes flip-flops.
    pub memory_limit: u64,
}

impl SiliconJob {
    /// Makes the job of a design's freshly generated Verilog.
    #[must_use]
    pub fn for_design(design: &Design, memory_limit: u64) -> Self {
        Self::for_array(EstimateJob::for_design(design, Top::Rcm), design, memory_limit)
    }

    /// Adds the list of the separate modules of the unit, as [`EstimateJob::with_leaves`] does.
    #[must_use]
    pub fn with_leaves(self, design: &Design) -> Self {
        Self { leaves_of: Some(design.unit().area_module.to_owned()), ..self }
    }

    /// Makes the job of a design whose Verilog is there.
    #[must_use]
    pub fn for_array(array: EstimateJob, design: &Design, memory_limit: u64) -> Self {
        Self { design: array, region_size: design.region_size(), leaves_of: None, memory_limit }
    }
}

/// Maps a design to `library` with Yosys, and times it with OpenSTA. Memories that are not mapped
/// get macros from `macros`.
///
/// # Errors
/// Fails if a tool is missing or fails, if the library lacks a cell that the design needs or the
/// area of one, or if cells and macros have different voltages.
pub fn map_to_silicon(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &SiliconJob,
    (library, macros): (&LibertyLibrary, &[LibertyLibrary]),
) -> Result<SiliconReport, SiliconError> {
    let gate_area_um2 = check_libraries(library, macros)?;
    let synthesis = job.design.top_synthesis();
    let mapped = map_array(toolchain, cache, synthesis, library, job.memory_limit)?;
    let unit_kinds = job.design.units(&mapped.netlist, synthesis)?;
    let (unit, shared) = unit_and_shared_cells(&mapped, &unit_kinds, &synthesis.array, library)?;
    let leaves = match &job.leaves_of {
        None => Vec::new(),
        Some(top) => {
            let within = (top.as_str(), job.memory_limit);
            let netlist = map_leaves(toolchain, cache, &job.design.synthesis, library, within)?;
            list_leaves(&netlist, library, top)?
        }
    };
    let units = job.design.units;
    let array = TimedArray {
        mapped: &mapped,
        name: &synthesis.array,
        clock: if job.design.bus.is_some() { AXI_CLOCK } else { ARRAY_CLOCK },
        unit_kinds: &unit_kinds,
        units,
        has_shared_cells: shared.cells > 0,
    };
    let ArrayTiming { tool: timer, path, leakage_nw } =
        time_array(toolchain, cache, &array, library)?;
    let memories: Vec<_> =
        mapped.memories.iter().map(|memory| plan_memory(memory, macros)).collect();
    let frames_per_second = path.mhz * 1e6 / count_to_f64(job.design.clocks_per_frame.max(1));
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
        leaves,
        memory_limit: job.memory_limit,
        memory: MemoryTotals::of_memories(&memories),
        memories,
        path,
        leakage_nw,
        frames_per_second,
    })
}

/// Returns the cells of one unit, of the most frequent kind, and those that the units share.
fn unit_and_shared_cells(
    mapped: &MappedArray,
    unit_kinds: &[String],
    array: &str,
    library: &LibertyLibrary,
) -> Result<(CellTotals, CellTotals), SiliconError> {
    let kinds: Vec<&str> = unit_kinds.iter().map(String::as_str).collect();
    let unit = CellTotals::of_module(&mapped.netlist, library, kinds[0], &[])?;
    if kinds[0] == array {
        return Ok((unit, CellTotals::default()));
    }
    let shared = CellTotals::of_module(&mapped.netlist, library, array, &kinds)?;
    Ok((unit, shared))
}

/// Checks that a library has the cells that every design needs, and that macros fit to it. Returns
/// the area of a gate equivalent in square micrometres.
///
/// # Errors
/// Fails if the library lacks a NAND of two inputs with an area or a flip-flop, if a library of
/// macros has no memory, or if cells and macros have different voltages.
pub fn check_libraries(
    library: &LibertyLibrary,
    macros: &[LibertyLibrary],
) -> Result<f64, SiliconError> {
    check_macros(library, macros)?;
    check_cells(library)
}

/// Refuses a library without the cells that every design needs. Returns the area of a gate
/// equivalent.
fn check_cells(library: &LibertyLibrary) -> Result<f64, SiliconError> {
    let missing = |missing| SiliconError::MissingCell { library: library.name.clone(), missing };
    let gate_area_um2 =
        library.gate_area().ok_or_else(|| missing("NAND of two inputs with an area"))?;
    let mut roles = library.cells.values().map(|cell| cell.role);
    match roles.any(|role| role == CellRole::FlipFlop) {
        true => Ok(gate_area_um2),
        false => Err(missing("flip-flop")),
    }
}

/// Refuses macros that are none, or have another voltage than the cells.
fn check_macros(library: &LibertyLibrary, macros: &[LibertyLibrary]) -> Result<(), SiliconError> {
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
