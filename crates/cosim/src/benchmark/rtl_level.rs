// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog in Verilator, over the same clocks: `-O3`, one thread, the RPU compiled once.

use std::path::Path;

use foveate_design::Design;
use foveate_tools::verilator::OptimizationLevel;

use super::benchmark_report::{BenchmarkLevel, LevelMeasurement, LevelRow};
use super::clock_rates::clock_rates;
use super::external_tools::{ExternalTools, RUN_TIME_LIMIT};
use super::pass_timer::{PassTimer, PassTimes};
use super::unpacked_inputs::UnpackedInputs;
use crate::error::CosimError;
use crate::job::CosimJob;
use crate::level::CosimLevel;
use crate::recording::Recording;
use crate::simulation::{SimulationRun, Simulator};
use crate::stimulus::Stimulus;

/// Builds the simulation, compares every port at every clock, and then times it.
#[allow(clippy::cast_precision_loss, reason = "rates need no 53 bits")]
pub(super) fn run_rtl(
    design: &Design,
    recording: &Recording,
    vectors: &UnpackedInputs,
    tools: ExternalTools<'_>,
    timer: PassTimer<'_>,
) -> Result<LevelRow, CosimError> {
    let stimulus = Stimulus { level: CosimLevel::Full, ..Stimulus::default() };
    let dut = CosimJob::new(design, stimulus, Path::new(""))?.dut(design);
    let run = SimulationRun {
        simulator: Simulator::Verilator,
        seed: 1,
        trace: false,
        toolchain: tools.toolchain,
        cache: tools.cache,
        limit: RUN_TIME_LIMIT,
        optimize: OptimizationLevel::FastRun,
    };
    let timed = run.run_timed(&dut, recording, timer.min_time)?;
    let time = PassTimes { passes: timed.passes, seconds: timed.memory_seconds };
    let measured = LevelMeasurement {
        peak_bytes: timed.peak_bytes,
        build_seconds: Some(timed.build.as_secs_f64()),
        is_cached: timed.is_cached,
        files_clocks_per_second: Some(vectors.clocks() as f64 / timed.file_pass.as_secs_f64()),
        unpacking_share: Some(timed.unpacking_seconds / timed.memory_seconds),
        ..clock_rates(design, vectors, time)
    };
    let name = short_version(&timed.version);
    Ok(LevelRow::measured(
        BenchmarkLevel::Rtl,
        &name,
        measured.with_agreement(BenchmarkLevel::Cycle, timed.agreement),
    ))
}

/// Shortens a banner to the name and the version, such as `Verilator 5.006`.
fn short_version(banner: &str) -> String {
    banner.split_whitespace().take(2).collect::<Vec<_>>().join(" ")
}
