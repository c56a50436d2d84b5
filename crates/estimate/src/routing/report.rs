// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report on a placed and routed design on each device ([`RouteReport`]), with its text for
//! a terminal and as Markdown. It names the longest path as the source does, by modules,
//! registers and ports ([`CriticalPath`]).

use super::netlist::{ModuleHierarchy, NetlistCell, PlacementNetlist, replaced_port};
use super::nextpnr_report::{CellPin, TimingPath};
use super::shortage::ResourceShortage;
use crate::speed::ClockEstimate;
use foveate_output::number_text::grouped;
use foveate_output::report::{Report, ReportPart, ReportTable};
use foveate_tools::ToolRecord;
use serde::{Deserialize, Serialize};

/// The version of the JSON report. It grows when a field changes its meaning or is removed.
pub const ROUTE_FORMAT_VERSION: u32 = 2;

/// The results of a design on one device or several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RouteReport {
    /// The version of the format, [`ROUTE_FORMAT_VERSION`].
    pub format_version: u32,
    /// The top module: `rpu`, `rcm` or `rcm_axi`.
    pub top: String,
    /// The hash of the RTL; see `sources_sha256` of the toolchain.
    pub rtl_sha256: String,
    /// The devices, in the order in which they were named.
    pub devices: Vec<DeviceResult>,
}

/// The result of a design on one device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DeviceResult {
    /// The name of the device.
    pub device: String,
    /// The part with package and speed grade.
    pub part: String,
    /// The tool that synthesized the design.
    pub synthesis: ToolRecord,
    /// The tool that placed and routed the design.
    pub route: ToolRecord,
    /// The resources and the clock; `None` if the device is too small.
    pub placed: Option<PlacementResult>,
    /// The resources that the device lacks; empty if the design fits.
    pub over: Vec<ResourceShortage>,
}

/// The resources that a design takes, and the clock that it reaches on a device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlacementResult {
    /// The look-up tables of four inputs (for ECP5, including those for carry and distributed RAM),
    /// or the logic cells (iCE40: such a table and a flip-flop).
    pub logic: ResourceUse,
    /// The flip-flops.
    pub ff: ResourceUse,
    /// The block RAM.
    pub block_ram: ResourceUse,
    /// The large single-port RAM.
    pub spram: ResourceUse,
    /// The multipliers.
    pub dsp: ResourceUse,
    /// The number of flip-flops at the ports, which the figures above do not include.
    pub port_ff: u64,
    /// The clock that was reached.
    pub fmax: ClockStatistics,
    /// The clock estimated from the netlist alone, if the delays of the family's cells are known;
    /// see [`ClockEstimate`].
    pub estimate: Option<ClockEstimate>,
    /// The longest path of the seed with the median clock.
    pub critical: Option<CriticalPath>,
}

/// The used and the available number of a resource.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResourceUse {
    /// The number that the design uses.
    pub used: u64,
    /// The number that the device has.
    pub available: u64,
}

/// The clock in MHz over the seeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClockStatistics {
    /// The median; of an even number of seeds, the lower of the two in the middle, which was
    /// reached.
    pub median_mhz: f64,
    /// The clock of the slowest seed.
    pub min_mhz: f64,
    /// The clock of the fastest seed.
    pub max_mhz: f64,
    /// The clock of each seed, from seed 1 on.
    pub seeds_mhz: Vec<f64>,
}

impl ClockStatistics {
    /// Makes the statistics, and returns them with the index of the median seed; `None` without
    /// seeds.
    pub(super) fn of(seeds_mhz: Vec<f64>) -> Option<(Self, usize)> {
        let mut order: Vec<usize> = (0..seeds_mhz.len()).collect();
        order.sort_by(|&a, &b| seeds_mhz[a].total_cmp(&seeds_mhz[b]));
        let (&slowest, &fastest) = (order.first()?, order.last()?);
        let median = order[(order.len() - 1) / 2];
        let [median_mhz, min_mhz, max_mhz] = [median, slowest, fastest].map(|at| seeds_mhz[at]);
        Some((Self { median_mhz, min_mhz, max_mhz, seeds_mhz }, median))
    }
}

impl RouteReport {
    /// Returns a sentence for each device that is too small.
    #[must_use]
    pub fn shortage_sentences(&self) -> Vec<String> {
        self.devices.iter().filter_map(DeviceResult::shortage_sentence).collect()
    }

    /// Returns the report as a table with a sentence on each device.
    #[must_use]
    pub fn table(&self) -> Report {
        let note = "logic: LUT4 of ECP5 and Gowin, logic cells of iCE40. fmax: the clock of the median seed, the slowest and \
             the fastest one. Flip-flops at the ports are left out.";
        let table = ReportTable::new(COLUMNS, self.devices.iter().map(row))
            .described(format!("{} placed and routed by nextpnr", self.top), Some(note.to_owned()));
        let misfits = self.shortage_sentences().into_iter().map(|misfit| misfit + ".");
        let sentences = self.devices.iter().filter_map(sentence).chain(misfits).collect();
        let table = ReportTable { is_stacked: true, ..table };
        Report(vec![ReportPart::Table(table), ReportPart::Sentences(sentences)])
    }
}

impl DeviceResult {
    fn shortage_sentence(&self) -> Option<String> {
        let each =
            |over: &ResourceShortage| format!("{} {} of {}", over.place, over.used, over.available);
        let all = self.over.iter().map(each).collect::<Vec<_>>().join(", ");
        (!self.over.is_empty()).then(|| format!("it does not fit {}: {all}", self.device))
    }
}

const COLUMNS: [&str; 9] =
    ["device", "logic", "FF", "block RAM", "SPRAM", "DSP", "fmax MHz", "slowest", "fastest"];

fn row(routed: &DeviceResult) -> Vec<String> {
    let cells = match &routed.placed {
        None => vec!["-".to_owned(); COLUMNS.len() - 1],
        Some(PlacementResult { logic, ff, block_ram, spram, dsp, fmax, .. }) => {
            let used =
                [logic, ff, block_ram, spram, dsp].map(|ResourceUse { used, .. }| grouped(*used));
            let clocks = [fmax.median_mhz, fmax.min_mhz, fmax.max_mhz];
            used.into_iter().chain(clocks.map(|mhz| format!("{mhz:.1}"))).collect()
        }
    };
    std::iter::once(routed.device.clone()).chain(cells).collect()
}

fn sentence(routed: &DeviceResult) -> Option<String> {
    let placed = routed.placed.as_ref()?;
    let DeviceResult { device, part, .. } = routed;
    let seeds = placed.fmax.seeds_mhz.len();
    let path = placed.critical.as_ref().map_or_else(String::new, critical);
    let seeds = if seeds == 1 { "1 seed".to_owned() } else { format!("{seeds} seeds") };
    let estimate = placed.estimate.as_ref().map_or_else(String::new, |estimate| {
        format!(" Expected by the netlist alone: {:.1} MHz.", estimate.mhz)
    });
    Some(format!("{device} is {part}; {seeds}.{path}{estimate}"))
}

fn critical(path: &CriticalPath) -> String {
    let end = |PathEnd { module, name }: &PathEnd| format!("{name} (module {module})");
    let share = 100.0 * path.wire_ns / path.ns;
    format!(
        " Longest path: {:.1} ns, {share:.0}% of it on {} wires, from {} to {}.",
        path.ns,
        path.wires,
        end(&path.from),
        end(&path.to)
    )
}

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
