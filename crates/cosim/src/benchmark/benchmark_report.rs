// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a benchmark.

use crate::timed_run::OutputAgreement;
use serde::Serialize;

/// The version of [`BenchmarkReport`] as JSON. It changes when a field changes its meaning or is
/// removed.
pub const BENCHMARK_FORMAT_VERSION: u32 = 2;

/// A level of the design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BenchmarkLevel {
    /// The functional model of whole frames, written to be read.
    FunctionalClear,
    /// The engine for whole frames, written to be fast.
    FunctionalFast,
    /// The timed model: the clock of every decision, word and loss, without ports.
    Transactions,
    /// The cycle-level model: every port at every clock.
    Cycle,
    /// The Verilog in a simulator.
    Rtl,
    /// The netlist after synthesis.
    Netlist,
}

/// The results of all levels of one design, from top to bottom.
#[derive(Clone, Debug, Serialize)]
pub struct BenchmarkReport {
    /// The version of the format, [`BENCHMARK_FORMAT_VERSION`].
    pub format_version: u32,
    /// The fingerprint of the design.
    pub design: String,
    /// The organization of the design.
    pub organization: &'static str,
    /// The number of regions.
    pub regions: u32,
    /// The width and height of a frame in pixels.
    pub size: (u32, u32),
    /// The number of frames that the functional levels take.
    pub frames: u64,
    /// The number of frames that the levels with clocks take: the same frames, with the last one
    /// repeated until all outputs have left.
    #[serde(rename = "streamed")]
    pub streamed_frames: u64,
    /// The number of clocks for these frames.
    pub clocks: u64,
    /// The vector instructions of the processor that the fast levels use.
    pub instructions: String,
    /// One row per level.
    pub rows: Vec<LevelRow>,
}

/// The result of one level.
#[derive(Clone, Debug, Serialize)]
pub struct LevelRow {
    /// The level.
    pub level: BenchmarkLevel,
    /// The name of what runs at this level.
    pub name: String,
    /// The measurements, unless the level could not run.
    pub measured: Option<LevelMeasurement>,
    /// The reason why the level could not run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
}

/// The cost of a level, and its agreement with another level.
#[derive(Clone, Debug, Default, Serialize)]
pub struct LevelMeasurement {
    /// The number of frames per second.
    pub frames_per_second: f64,
    /// The number of clocks per second, if the level has clocks.
    pub clocks_per_second: Option<f64>,
    /// The number of pixels of frames per second.
    pub pixels_per_second: f64,
    /// The clocks per second divided by those of the RTL.
    pub times_rtl: Option<f64>,
    /// The largest number of bytes that the level takes, if the system reports it.
    pub peak_bytes: Option<u64>,
    /// The number of seconds to build the level, or `None` if it is a part of this program.
    pub build_seconds: Option<f64>,
    /// The build was found in the cache, so its seconds mean nothing.
    pub is_cached: bool,
    /// The level with which this level was compared.
    #[serde(rename = "same_as")]
    pub compared_with: Option<BenchmarkLevel>,
    /// The number of values that were compared.
    pub compared: u64,
    /// The number of values that differ.
    pub differing: u64,
    /// The number of timed passes over the frames.
    pub passes: u64,
    /// The number of seconds of these passes.
    pub seconds: f64,
    /// The number of clocks per second with inputs and outputs in files. `clocks_per_second` is
    /// measured from memory.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub files_clocks_per_second: Option<f64>,
    /// The share of the time for unpacking the inputs, 0 to 1.
    #[serde(rename = "unpacking", skip_serializing_if = "Option::is_none")]
    pub unpacking_share: Option<f64>,
}

impl LevelMeasurement {
    pub(super) fn with_agreement(self, level: BenchmarkLevel, agreement: OutputAgreement) -> Self {
        let OutputAgreement { compared, differing } = agreement;
        Self { compared_with: Some(level), compared, differing, ..self }
    }
}

impl LevelRow {
    pub(super) fn measured(level: BenchmarkLevel, name: &str, measured: LevelMeasurement) -> Self {
        Self { level, name: name.to_owned(), measured: Some(measured), missing: None }
    }

    pub(super) fn not_run(level: BenchmarkLevel, name: &str, why: String) -> Self {
        Self { level, name: name.to_owned(), measured: None, missing: Some(why) }
    }
}

impl BenchmarkReport {
    /// Returns the number of values that differ between levels that should agree.
    #[must_use]
    pub fn differing_values(&self) -> u64 {
        self.rows.iter().filter_map(|row| row.measured.as_ref()).map(|row| row.differing).sum()
    }

    /// Fills in the ratios of the levels' speeds to that of the RTL. A netlist has no ratio,
    /// because one RPU is not an array.
    pub(super) fn fill_in_ratios(&mut self) {
        let rtl = self.rows.iter().find(|row| row.level == BenchmarkLevel::Rtl);
        let Some(rtl) = rtl.and_then(|row| row.measured.as_ref()?.clocks_per_second) else {
            return;
        };
        for row in self.rows.iter_mut().filter(|row| row.level != BenchmarkLevel::Netlist) {
            if let Some(measured) = &mut row.measured {
                measured.times_rtl = measured.clocks_per_second.map(|clocks| clocks / rtl);
            }
        }
    }
}
