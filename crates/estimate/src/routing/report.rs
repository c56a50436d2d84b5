// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report on a placed and routed design on each device.

use serde::{Deserialize, Serialize};

use super::critical_path::CriticalPath;
use super::shortage::ResourceShortage;
use crate::clock::ClockEstimate;
use foveate_tools::ToolRecord;

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
}

impl DeviceResult {
    fn shortage_sentence(&self) -> Option<String> {
        let each =
            |over: &ResourceShortage| format!("{} {} of {}", over.place, over.used, over.available);
        let all = self.over.iter().map(each).collect::<Vec<_>>().join(", ");
        (!self.over.is_empty()).then(|| format!("it does not fit {}: {all}", self.device))
    }
}
