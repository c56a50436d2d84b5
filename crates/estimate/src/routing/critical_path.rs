// SPDX-License-Identifier: MIT OR Apache-2.0
//! The longest path of a placement in the names of the source: modules, registers and ports.

use serde::{Deserialize, Serialize};

use super::hierarchy::ModuleHierarchy;
use super::netlist::{NetlistCell, PlacementNetlist};
use super::nextpnr_report::{CellPin, TimingPath};
use super::port_registers::replaced_port;

/// The longest path between two edges of the clock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CriticalPath {
    /// The start of the path.
    pub from: PathEnd,
    /// The end of the path.
    pub to: PathEnd,
    /// The delay of the path in nanoseconds.
    pub ns: f64,
    /// The delay of its wires in nanoseconds.
    pub wire_ns: f64,
    /// The number of its wires that have a delay.
    pub wires: u64,
}

/// A register, memory or port at an end of a path.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PathEnd {
    /// The module in which it is declared.
    pub module: String,
    /// The name below the top, preceded by the instances that contain it.
    pub name: String,
}

/// The netlist as it was placed, and the hierarchy of modules before it was flattened. Both are
/// needed to name cells and nets as the source does.
pub(super) struct SourceNames<'a> {
    pub(super) top: &'a str,
    pub(super) netlist: &'a PlacementNetlist,
    pub(super) hierarchy: &'a ModuleHierarchy,
}

impl SourceNames<'_> {
    /// Returns the path in the names of the source.
    pub(super) fn path(&self, path: &TimingPath) -> Option<CriticalPath> {
        let first = path.steps.iter().find(|step| step.is_wire())?;
        let last = path.steps.last()?;
        let wires = || path.steps.iter().filter(|step| step.is_wire() && step.delay > 0.0);
        let start = first.net.as_ref().and_then(|net| self.netlist.net(net));
        let end = self.register(&last.to).or_else(|| {
            let last = path.steps.iter().rev().find(|step| step.is_wire())?;
            self.netlist.name(self.netlist.net(last.net.as_ref()?)?)
        });
        Some(CriticalPath {
            from: self.end(start.and_then(|net| self.netlist.name(net)), &first.from),
            to: self.end(end, &last.to),
            ns: path.delay(),
            wire_ns: wires().map(|step| step.delay).sum(),
            wires: wires().count() as u64,
        })
    }

    /// Returns a name with its module; the name of the cell if no net has a name in the source.
    fn end(&self, name: Option<String>, pin: &CellPin) -> PathEnd {
        let name = name.unwrap_or_else(|| format!("{} ({})", pin.cell, pin.port));
        PathEnd { module: self.hierarchy.module_of(self.top, &name), name }
    }

    /// Returns the register, port or memory at a pin where a path ends. iCE40 packs a table and the
    /// flip-flop behind it into one cell, which has the name of the table.
    fn register(&self, pin: &CellPin) -> Option<String> {
        if let Some(port) = replaced_port(&pin.cell) {
            return Some(port.trim_end_matches("_DFFLC").to_owned());
        }
        let (name, cell) = self.cell(&pin.cell)?;
        if let Some(out) = cell.net("Q") {
            return self.netlist.name(out);
        }
        if let Some(table) = cell.net("O") {
            let mut behind =
                self.netlist.cells.iter().filter(|(_, cell)| cell.net("D") == Some(table));
            let (name, register) = behind.next()?;
            return match replaced_port(name) {
                Some(port) => Some(port.to_owned()),
                None => self.netlist.name(register.net("Q")?),
            };
        }
        // The name of a memory ends before the suffix of Yosys.
        Some(format!("{} ({} {})", memory_name(name), cell.kind, pin.port))
    }

    /// Returns the cell of the netlist that became a cell of the placement, which may have a
    /// suffix.
    fn cell<'a>(&'a self, name: &'a str) -> Option<(&'a str, &'a NetlistCell)> {
        let shorter = [Some(name), name.rsplit_once('$').map(|(name, _)| name)];
        let packed = ["_LC", "_DFFLC"].map(|suffix| name.strip_suffix(suffix));
        shorter
            .into_iter()
            .chain(packed)
            .flatten()
            .find_map(|name| Some((name, self.netlist.cells.get(name)?)))
    }
}

/// Returns the name of a memory without the suffixes of Yosys: `u_store.words_q` for
/// `u_store.words_q.0.1` and `u_store.words_q_DP16KD`.
fn memory_name(cell: &str) -> &str {
    let numbered = cell.trim_end_matches(|c: char| c == '.' || c.is_ascii_digit());
    let kinds = ["_DP16KD", "_TRELLIS", "_SB_", "_MULT"];
    kinds.iter().find_map(|kind| numbered.split_once(kind)).map_or(numbered, |(name, _)| name)
}
