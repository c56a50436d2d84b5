// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a co-simulation, for people and for programs.

use crate::level::CosimLevel;
use crate::mismatch::Mismatch;
use crate::netlist::NetlistRecord;
use crate::simulation::Simulator;
use crate::situations::Occurrences;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::PathBuf;

/// The result of one co-simulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CosimReport {
    /// The name of the run for people, such as `rpu verilator`.
    pub name: String,
    /// The fingerprint of the design, as in the README of its core. [`CosimReport::grid`] is the
    /// part of it that was simulated.
    pub design: String,
    /// The part of the hardware that was simulated.
    pub level: CosimLevel,
    /// The columns and rows of regions.
    pub grid: (u32, u32),
    /// The simulator.
    pub simulator: Simulator,
    /// The version that the simulator reports.
    pub simulator_version: String,
    /// The SHA-256 of the Verilog: the hash of the text that `sha256sum` prints for all files in
    /// the order of their names. The area estimate reports the same hash for the same Verilog.
    pub rtl_sha256: String,
    /// The netlist that was simulated instead of the Verilog, if there was one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub netlist: Option<NetlistRecord>,
    /// The seed of the vectors.
    pub seed: u64,
    /// The number of sequences of frames; each begins with a reset.
    pub sequences: u64,
    /// The number of frames that were streamed.
    pub frames: u64,
    /// The number of clock edges, up to the first mismatch.
    pub clocks: u64,
    /// The number of values that were compared: every output of every region at each of these
    /// edges.
    pub comparisons: u64,
    /// The number of times that each situation occurred that the design can have; empty if only
    /// frames were played.
    #[serde(default)]
    pub situations: Occurrences,
    /// The first mismatch.
    pub mismatch: Option<Mismatch>,
    /// The folder that replays the mismatch.
    pub replay: Option<PathBuf>,
    /// The file with the waves of a run without a mismatch, if they were asked for.
    pub waves: Option<PathBuf>,
    /// The time of each step.
    pub seconds: StepSeconds,
}

impl CosimReport {
    /// Returns true if model and RTL agree. A run without a comparison has not passed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.mismatch.is_none() && self.comparisons > 0
    }
}

/// The durations of the steps, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepSeconds {
    /// The time to make the vectors and run the model.
    pub vectors: f64,
    /// The time to build the simulation; almost zero if it was found in the cache.
    pub build: f64,
    /// The time to simulate and compare.
    pub run: f64,
}

impl fmt::Display for CosimReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, frames, clocks, comparisons, .. } = self;
        match &self.mismatch {
            None if !self.passed() => write!(f, "{name}: nothing was compared"),
            None => write!(
                f,
                "{name}: {frames} frames, {clocks} clocks, {comparisons} values compared, no mismatch"
            ),
            Some(mismatch) => write!(f, "{name}: mismatch after {clocks} clocks: {mismatch}"),
        }
    }
}
