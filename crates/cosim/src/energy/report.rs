// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report on the energy of a design.

use serde::{Deserialize, Serialize};

pub use crate::energy::energy_sum::PartEnergies;

/// The version of the JSON report. It grows when a field changes its meaning or is removed.
pub const ENERGY_FORMAT_VERSION: u32 = 1;

/// The energy of a design, from the activity of a clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyReport {
    /// The version of the format, [`ENERGY_FORMAT_VERSION`].
    pub format_version: u32,
    /// The clip.
    pub clip: String,
    /// The number of its frames that were played.
    pub frames: u64,
    /// The name of the unit for people: `RPU` or `lane`.
    pub unit: String,
    /// The number of units of the array.
    pub units: u64,
    /// The number of units that were simulated, spread evenly over the frame.
    pub simulated_units: u64,
    /// The number of regions.
    pub regions: u64,
    /// The number of cells that RPUs share. Their energy is in no figure. It is 0 for lanes, because the
    /// energy of the cells that they share is in all figures.
    pub unmeasured_cells: u64,
    /// The frames per second for which powers are given.
    pub frame_rate: f64,
    /// The clock in MHz of a design whose clock runs always.
    pub clock_mhz: f64,
    /// The leakage of the array in milliwatts, which is part of every power.
    pub leakage_mw: f64,
    /// The measured stretches: a quiet, a usual and the busiest one.
    pub stretches: Vec<StretchEnergy>,
}

/// The energy during a stretch of a clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StretchEnergy {
    /// `quiet`, `usual` or `busiest`, by the number of sent regions.
    pub name: String,
    /// The number of the first frame, from 0.
    pub first_frame: u64,
    /// The number of frames.
    pub frames: u64,
    /// The share of regions that are sent.
    pub sent_share: f64,
    /// The number of clocks of a frame of the array.
    pub clocks_per_frame: f64,
    /// The energy of one unit in a clock, in picojoules.
    pub unit_pj_per_clock: PartEnergies,
    /// The energy of a region in a frame, in nanojoules, with its share of the logic that units share.
    pub region_nj_per_frame: PartEnergies,
    /// The power of the array in milliwatts if the clock stops when a frame is done.
    pub stopped_clock_mw: f64,
    /// The power of the array in milliwatts if the clock runs always; `None` if the clock is too slow for
    /// the frames.
    pub running_clock_mw: Option<f64>,
    /// The energy of one unit in a clock, in picojoules, if every net changed at every tenth clock, which
    /// tools assume without a measured activity.
    pub default_activity_pj_per_clock: f64,
}
