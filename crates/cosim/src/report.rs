// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a co-simulation, for people and for programs.

use crate::level::Level;
use crate::mismatch::Mismatch;
use crate::netlist::NetlistRecord;
use crate::simulate::Simulator;
use crate::situations::Occurrences;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::PathBuf;

/// The result of one co-simulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CosimReport {
    /// Name for people, such as `rpu verilator`.
    pub name: String,
    /// Fingerprint of the design, as in the README of its core. What was simulated of it says
    /// [`CosimReport::grid`].
    pub design: String,
    /// How much of the hardware was simulated.
    pub level: Level,
    /// Regions side by side, and one below the other.
    pub grid: (u32, u32),
    /// The simulator.
    pub simulator: Simulator,
    /// The version that the simulator reports.
    pub simulator_version: String,
    /// SHA-256 of the Verilog: the hash of the text that `sha256sum` prints for all files in the order of
    /// their names. The area estimate reports the same hash for the same Verilog.
    pub rtl_sha256: String,
    /// The netlist that was simulated instead, if it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub netlist: Option<NetlistRecord>,
    /// Seed of the vectors.
    pub seed: u64,
    /// Sequences of frames, each after a reset.
    pub sequences: u64,
    /// Frames that were streamed.
    pub frames: u64,
    /// Clock edges, up to the first mismatch.
    pub clocks: u64,
    /// Values that were compared: every output of every region at each of these edges.
    pub comparisons: u64,
    /// How often each situation occurred that the design can have; none where only frames were asked for.
    #[serde(default)]
    pub situations: Occurrences,
    /// The first mismatch.
    pub mismatch: Option<Mismatch>,
    /// The folder that replays it.
    pub replay: Option<PathBuf>,
    /// Waves of a run without a mismatch, if they were asked for.
    pub waves: Option<PathBuf>,
    /// Where the time went.
    pub seconds: Seconds,
}

impl CosimReport {
    /// Whether model and RTL agree. Without a single comparison they do not.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.mismatch.is_none() && self.comparisons > 0
    }
}

/// Durations in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seconds {
    /// To make the vectors and run the model.
    pub vectors: f64,
    /// To build the simulation; almost nothing if it was found in the cache.
    pub build: f64,
    /// To simulate and compare.
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
