// SPDX-License-Identifier: MIT OR Apache-2.0
//! The longest path and the leakage of an array in the cells of a library. OpenSTA finds those
//! of a module ([`time_module`]); those of the array follow from one of its units with the logic
//! that the units share ([`time_array`]).

use super::error::SiliconError;
use super::library::{CELLS, LibertyLibrary};
use super::mapping::MappedArray;
use super::net_names::source_name;
use super::unit_instances::{LONE_UNIT, with_lone_unit, with_units};
use crate::speed::count_to_f64;
use foveate_tools::opensta::{self, OpenStaJob};
use foveate_tools::{Cache, Tool, ToolRecord, Toolchain};
use serde::{Deserialize, Serialize};

const NETLIST: &str = "netlist.v";

/// The period of the clock in nanoseconds. OpenSTA computes with 24 bits, so a longer one would
/// cost digits of the path.
const PERIOD_NS: f64 = 1000.0;

/// The lines between which the script prints the reports.
const PATH_MARK: &str = "foveate: longest path";

const POWER_MARK: &str = "foveate: power";

const END_MARK: &str = "foveate: end";

/// The longest path of an array with one of its units, from register to register, or from or to its
/// ports.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SiliconPath {
    /// The delay with the setup time of its end, in nanoseconds.
    pub ns: f64,
    /// The highest clock in MHz.
    pub mhz: f64,
    /// The number of cells on the path, with the register at its start and without that at its end.
    pub cells: u64,
    /// The register or port at which the path begins.
    pub from: String,
    /// The register or port at which the path ends.
    pub to: String,
}

/// The longest path and the leakage of a module, from OpenSTA.
pub(super) struct ModuleTiming {
    pub(super) tool: ToolRecord,
    /// `None` if no path leads from a register or port to another.
    pub(super) path: Option<SiliconPath>,
    pub(super) leakage_nw: f64,
}

/// Times the module `top` of a netlist.
pub(super) fn time_module(
    toolchain: &Toolchain,
    cache: &Cache,
    (verilog, top, clock): (&str, &str, &str),
    library: &LibertyLibrary,
) -> Result<ModuleTiming, SiliconError> {
    let version = toolchain.find(Tool::OpenSta)?.banner;
    let unit = library.time_unit_ns;
    // Leakage does not depend on the activity. Without one, OpenSTA of 2019 would propagate that of
    // the ports, and crashes in large netlists.
    let script = format!(
        "read_liberty {CELLS}\n\
         read_verilog {NETLIST}\n\
         link_design {top}\n\
         create_clock -name clock -period {period} [get_ports {clock}]\n\
         set_input_delay 0 -clock clock [all_inputs]\n\
         set_output_delay 0 -clock clock [all_outputs]\n\
         puts \"{PATH_MARK}\"\n\
         report_checks -path_delay max -digits 6\n\
         puts \"{POWER_MARK}\"\n\
         set_power_activity -global -activity 0.1\n\
         report_power -digits 6\n\
         puts \"{END_MARK}\"\n",
        period = PERIOD_NS / unit
    );
    let files = vec![library.source_without_wires(), (NETLIST.to_owned(), verilog.to_owned())];
    let log = opensta::run(toolchain, cache, &OpenStaJob { files, script })?;
    let failed = |reason: &str| SiliconError::Timing { reason: reason.to_owned() };
    if let Some(error) = log.lines().find(|line| line.starts_with("Error")) {
        return Err(failed(error));
    }
    let part = |from: &str, to: &str| {
        let behind = log.split_once(from).map(|(_, behind)| behind);
        behind.and_then(|text| text.split_once(to)).map(|(part, _)| part)
    };
    let checks = part(PATH_MARK, POWER_MARK).ok_or_else(|| failed("it has printed no path"))?;
    let power = part(POWER_MARK, END_MARK).ok_or_else(|| failed("it has printed no power"))?;
    Ok(ModuleTiming {
        tool: ToolRecord {
            name: "OpenSTA".to_owned(),
            version,
            flags: "ideal clock, no wires, ports without delay and load".to_owned(),
        },
        path: path_of_report(checks, unit).map_err(failed)?,
        leakage_nw: leakage_nw(power).ok_or_else(|| failed("its report has no leakage"))?,
    })
}

/// Reads the report of the longest path, if there is one.
fn path_of_report(report: &str, unit: f64) -> Result<Option<SiliconPath>, &'static str> {
    if report.contains("No paths found") {
        return Ok(None);
    }
    let end = |name: &str| {
        let line = report.lines().find_map(|line| line.trim().strip_prefix(name))?;
        line.split_whitespace().next().map(str::to_owned)
    };
    let slack = report.lines().find(|line| line.contains(" slack "));
    let slack = slack.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    let slack = slack.ok_or("its report has no slack")?;
    let ns = PERIOD_NS - slack * unit;
    // A line of the path has an edge and a pin, and each cell has two lines.
    let arrival = report.split("data arrival time").next().unwrap_or_default();
    let pins = arrival.lines().filter_map(|line| {
        let mut words = line.split_whitespace().skip(2);
        let is_edge = matches!(words.next(), Some("^" | "v"));
        let (cell, _) = words.next().filter(|_| is_edge)?.rsplit_once('/')?;
        Some(cell)
    });
    let mut cells: Vec<&str> = pins.collect();
    cells.dedup();
    let last = cells.last().map(|cell| (*cell).to_owned());
    let ends_in_register = last.is_some() && last == end("Endpoint:");
    Ok(Some(SiliconPath {
        ns,
        mhz: 1000.0 / ns,
        cells: cells.len() as u64 - u64::from(ends_in_register),
        from: end("Startpoint:").ok_or("the path has no start")?,
        to: end("Endpoint:").ok_or("the path has no end")?,
    }))
}

/// Reads the leakage from the total of the report of power, which is in watts.
fn leakage_nw(report: &str) -> Option<f64> {
    let total = report.lines().find(|line| line.starts_with("Total"))?;
    let watts: f64 = total.split_whitespace().nth(3)?.parse().ok()?;
    Some(watts * 1e9)
}

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

#[cfg(test)]
mod tests {

    use super::*;

    const CHECKS: &str = "
    Startpoint: cell_7 (rising edge-triggered flip-flop clocked by clock)
    Endpoint: u_core/cell_9
          (rising edge-triggered flip-flop clocked by clock)
    Path Group: clock
    Delay      Time   Description
    -------------------------------------------------------------
       0.0000    0.0000   clock clock (rise edge)
       0.0000    0.0000   clock network delay (ideal)
       0.0000    0.0000 ^ cell_7/CLK (DFFPOSX1)
       0.5026    0.5026 v cell_7/Q (DFFPOSX1)
       1.1136    1.6162 v cell_8/Y (OR2X1)
       0.0000    1.6162 v u_core/cell_9/D (DFFPOSX1)
             1.6162   data arrival time
      1000.0000  1000.0000   clock clock (rise edge)
         998.0000 ^ u_core/cell_9/CLK (DFFPOSX1)
    -------------------------------------------------------------
           998.0000   slack (MET)
    ";

    #[test]
    fn a_report_of_a_path_is_read() {
        let path = path_of_report(CHECKS, 1.0).unwrap().unwrap();
        assert_eq!((path.from.as_str(), path.to.as_str()), ("cell_7", "u_core/cell_9"));
        assert_eq!((path.ns, path.mhz, path.cells), (2.0, 500.0, 2));
        assert_eq!(path_of_report("No paths found.", 1.0), Ok(None));
        assert!(path_of_report("nothing", 1.0).is_err());
    }

    #[test]
    fn the_leakage_is_that_of_the_total() {
        let report = "Group  Internal Switching Leakage Total\nSequential 1.0e-3 2.0e-5 3.0e-9 1.0e-3 60%\n\
                      Total   2.0e-03 2.0e-04 2.7e-07 2.6e-03 100.0%\n";
        assert_eq!(leakage_nw(report).map(f64::round), Some(270.0));
        assert_eq!(leakage_nw("nothing"), None);
    }
}
