// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is reported of a design on each device.

use serde::{Deserialize, Serialize};

use super::critical::CriticalPath;
use super::over::Over;
use crate::clock::ClockEstimate;
use foveate_toolchain::ToolRecord;

/// The version of the JSON report. It grows when a field changes its meaning or goes away.
pub const ROUTE_FORMAT_VERSION: u32 = 2;

/// A design, placed and routed on one device or several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RouteReport {
    /// [`ROUTE_FORMAT_VERSION`].
    pub format_version: u32,
    /// The module on top: `rpu`, `rcm` or `rcm_axi`.
    pub top: String,
    /// The hash of the RTL; see `sources_sha256` of the toolchain.
    pub rtl_sha256: String,
    /// The devices, in the order in which they were named.
    pub devices: Vec<Routed>,
}

/// A design on one device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Routed {
    /// The name of the device.
    pub device: String,
    /// The part with package and speed grade.
    pub part: String,
    /// What synthesized it.
    pub synthesis: ToolRecord,
    /// What placed it.
    pub route: ToolRecord,
    /// What was reached; nothing where the device is too small.
    pub placed: Option<Placed>,
    /// What the device has too few of; nothing where the design fits.
    pub over: Vec<Over>,
}

/// What a design takes of a device, and the clock that it reaches there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Placed {
    /// Look-up tables of four inputs (ECP5: those for carry and distributed RAM too), or logic cells (iCE40:
    /// such a table and a flip-flop).
    pub logic: Used,
    /// Flip-flops.
    pub ff: Used,
    /// Block RAM.
    pub block_ram: Used,
    /// Large single-port RAM.
    pub spram: Used,
    /// Multipliers.
    pub dsp: Used,
    /// The flip-flops at the ports, which are not in the figures above.
    pub port_ff: u64,
    /// The clock.
    pub fmax: Fmax,
    /// What the netlist alone lets expect, where cells of the family have delays; see [`ClockEstimate`].
    pub estimate: Option<ClockEstimate>,
    /// The longest path of the seed whose clock is the median.
    pub critical: Option<CriticalPath>,
}

/// How many there are, and how many of them are taken.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Used {
    /// Taken.
    pub used: u64,
    /// There.
    pub available: u64,
}

/// The clock in MHz over seeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fmax {
    /// Of an even number of seeds, the lower one of the two in the middle: it was reached.
    pub median_mhz: f64,
    /// The slowest seed.
    pub min_mhz: f64,
    /// The fastest seed.
    pub max_mhz: f64,
    /// Each seed, from 1 on.
    pub seeds_mhz: Vec<f64>,
}

impl Fmax {
    /// Of at least one seed; and which of them is the median.
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
    /// A sentence for each device that is too small.
    #[must_use]
    pub fn misfits(&self) -> Vec<String> {
        self.devices.iter().filter_map(Routed::misfit).collect()
    }
}

impl Routed {
    fn misfit(&self) -> Option<String> {
        let each = |over: &Over| format!("{} {} of {}", over.place, over.used, over.available);
        let all = self.over.iter().map(each).collect::<Vec<_>>().join(", ");
        (!self.over.is_empty()).then(|| format!("it does not fit {}: {all}", self.device))
    }
}
