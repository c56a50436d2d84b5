// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog in Verilator, over the same clocks: `-O3`, one thread, the RPU compiled once.

use std::path::Path;

use foveate_cosim::{Job, Level as Simulated, Recording, Run, Simulator, Stimulus};
use foveate_design::Design;
use foveate_toolchain::verilator::Optimize;

use crate::error::BenchError;
use crate::rate::per_clock;
use crate::report::{Level, LevelRow, Measured};
use crate::timer::{Time, Timer};
use crate::tools::{LIMIT, Tools};
use crate::vectors::Vectors;

/// Builds the simulation, compares every port at every clock, and then times it.
#[allow(clippy::cast_precision_loss, reason = "rates need no 53 bits")]
pub(crate) fn rtl(
    design: &Design,
    recording: &Recording,
    vectors: &Vectors,
    tools: Tools<'_>,
    timer: Timer<'_>,
) -> Result<LevelRow, BenchError> {
    let stimulus = Stimulus { level: Simulated::Full, ..Stimulus::default() };
    let dut = Job::new(design, stimulus, Path::new(""))?.dut(design);
    let run = Run {
        simulator: Simulator::Verilator,
        seed: 1,
        trace: false,
        toolchain: tools.toolchain,
        cache: tools.cache,
        limit: LIMIT,
        optimize: Optimize::Run,
    };
    let timed = run.timed(&dut, recording, timer.at_least)?;
    let time = Time { passes: timed.passes, seconds: timed.seconds };
    let measured = Measured {
        peak_bytes: timed.peak_bytes,
        build_seconds: Some(timed.build.as_secs_f64()),
        is_cached: timed.is_cached,
        files_clocks_per_second: Some(vectors.clocks() as f64 / timed.files.as_secs_f64()),
        unpacking: Some(timed.applying / timed.seconds),
        ..per_clock(design, vectors, time)
    };
    let name = short_version(&timed.version);
    Ok(LevelRow::of(Level::Rtl, &name, measured.agrees(Level::Cycle, timed.agreement)))
}

/// Shortens a banner to the name and the version, such as `Verilator 5.006`.
fn short_version(banner: &str) -> String {
    banner.split_whitespace().take(2).collect::<Vec<_>>().join(" ")
}
