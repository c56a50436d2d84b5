// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report on a design in the cells of a library.

use foveate_tools::ToolRecord;
use serde::{Deserialize, Serialize};

use super::cell_totals::CellTotals;
use super::leaves::SiliconLeaf;
use super::memory_plan::MemoryFigures;
use super::timing::SiliconPath;
use crate::speed::count_to_f64;

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

    /// Returns the side in micrometres of a pixel under which the circuit of its region fits: the N x N
    /// pixels of a region together have as much area as a region's share of cells and macros.
    #[must_use]
    pub fn pixel_pitch_um(&self) -> f64 {
        let of_region = self.area_mm2() * 1e6 / count_to_f64(self.regions);
        of_region.sqrt() / f64::from(self.region_size)
    }
}
