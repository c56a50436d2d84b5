// SPDX-License-Identifier: MIT OR Apache-2.0
//! The longest path and the leakage of an array, from the timing of one of its units with the logic that
//! the units share.

use foveate_tools::{Cache, ToolRecord, Toolchain};

use super::error::SiliconError;
use super::library::LibertyLibrary;
use super::mapping::MappedArray;
use super::net_names::source_name;
use super::timing::{ModuleTiming, SiliconPath, time_module};
use super::unit_instances::{LONE_UNIT, with_lone_unit, with_units};
use crate::speed::count_to_f64;

/// The clock port of every array without a bus, and of every unit.
pub(super) const ARRAY_CLOCK: &str = "clk_i";

/// An array in the cells of a library.
pub(super) struct TimedArray<'a> {
    pub(super) mapped: &'a MappedArray,
    pub(super) name: &'a str,
    pub(super) clock: &'a str,
    /// The modules of the netlist that are units, the most frequent first.
    pub(super) unit_kinds: &'a [String],
    pub(super) units: u64,
    /// True if the units share logic.
    pub(super) has_shared_cells: bool,
}

/// The longest path and the leakage of an array.
pub(super) struct ArrayTiming {
    pub(super) tool: ToolRecord,
    pub(super) path: SiliconPath,
    pub(super) leakage_nw: f64,
}

pub(super) fn time_array(
    toolchain: &Toolchain,
    cache: &Cache,
    array: &TimedArray<'_>,
    library: &LibertyLibrary,
) -> Result<ArrayTiming, SiliconError> {
    let TimedArray { mapped, unit_kinds, .. } = array;
    let time = |verilog: &str, top: &str, clock: &str| {
        time_module(toolchain, cache, (verilog, top, clock), library)
    };
    let one_unit = with_units(&mapped.verilog, unit_kinds, Some(&unit_kinds[0]));
    let ModuleTiming { tool, path, leakage_nw } = time(&one_unit, array.name, array.clock)?;
    let mut paths = vec![(path, array.name)];
    if !mapped.memories.is_empty() {
        // The ports of memories inside a unit are not connected in the array.
        let alone = with_lone_unit(&mapped.verilog, &unit_kinds[0]);
        paths.push((time(&alone, LONE_UNIT, ARRAY_CLOCK)?.path, &unit_kinds[0]));
    }
    let named = paths.into_iter().filter_map(|(path, top)| {
        let path = path?;
        let [from, to] = [&path.from, &path.to].map(|end| source_name(&mapped.json, top, end));
        Some(SiliconPath { from, to, ..path })
    });
    let path = named.max_by(|a, b| a.ns.total_cmp(&b.ns)).ok_or_else(|| SiliconError::Timing {
        reason: "there is no path between registers or ports".to_owned(),
    })?;
    let shared_leakage_nw = if array.has_shared_cells {
        let no_unit = with_units(&mapped.verilog, unit_kinds, None);
        time(&no_unit, array.name, array.clock)?.leakage_nw
    } else {
        0.0
    };
    let of_unit = leakage_nw - shared_leakage_nw;
    let leakage_nw = shared_leakage_nw + of_unit * count_to_f64(array.units);
    Ok(ArrayTiming { tool, path, leakage_nw })
}
