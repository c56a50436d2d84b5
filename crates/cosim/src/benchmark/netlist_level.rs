// SPDX-License-Identifier: MIT OR Apache-2.0
//! The levels that external programs simulate, clock by clock: the Verilog in Verilator
//! ([`run_rtl`]), with `-O3`, in one thread and with the RPU compiled once, and the netlist in
//! Icarus ([`run_netlist`]). The netlist is what Yosys makes of one RPU, of one serial lane, or
//! of a small raster core; it gets the first regions of the same frames.

use super::benchmark_report::{BenchmarkLevel, LevelMeasurement, LevelRow};
use super::pass_timer::{PassTimer, PassTimes};
use super::unpacked_inputs::UnpackedInputs;
use crate::error::CosimError;
use crate::job::CosimJob;
use crate::level::CosimLevel;
use crate::recording::Recording;
use crate::simulation::{SimulationRun, Simulator};
use crate::stimulus::Stimulus;
use crate::timed_run::OutputAgreement;
use foveate_design::{ArrayStructure, Design};
use foveate_pixels::Frame;
use foveate_tools::verilator::OptimizationLevel;
use foveate_tools::{Cache, ScratchFolder, Toolchain};
use std::path::Path;
use std::time::{Duration, Instant};

/// Returns the name of the level in reports.
pub(super) fn level_name(design: &Design) -> String {
    format!("1 {} in Icarus", design.unit().name)
}

/// Synthesizes and simulates the netlist. Every port is compared at every clock up to the first
/// that differs.
#[allow(clippy::cast_precision_loss, reason = "rates need no 53 bits")]
pub(super) fn run_netlist(
    design: &Design,
    frames: &[Frame],
    seed: u64,
    tools: ExternalTools<'_>,
) -> Result<LevelRow, CosimError> {
    let part = design_of_unit(design)?;
    let cut = |frame: &Frame| {
        let pixel = |x: u32, y: u32| frame.get_clamped(x.into(), y.into());
        Frame::from_fn(part.width(), part.height(), part.pixel_bits(), pixel)
    };
    let frames = frames.iter().map(cut).collect::<Result<Vec<_>, _>>()?;
    let count = frames.len() as u64;
    let parent = std::env::temp_dir();
    let folder =
        ScratchFolder::new().map_err(CosimError::temporary("create a folder in", &parent))?;
    let stimulus =
        Stimulus { level: CosimLevel::Rpu, seed, rounds: 0, frames, sufficient_clocks: None };
    let mut job = CosimJob::new(&part, stimulus, &folder.path().join("replay"))?;
    job.limit = RUN_TIME_LIMIT;
    let start = Instant::now();
    job.netlist = Some(job.synthesize(tools.toolchain, tools.cache)?);
    let synthesis = start.elapsed().as_secs_f64();
    job.simulator = Simulator::Iverilog;
    let report = job.run(tools.toolchain, tools.cache, &mut |_| {})?;
    let frames_per_second = count as f64 / report.seconds.run;
    let pixels = f64::from(part.width()) * f64::from(part.height());
    let measured = LevelMeasurement {
        frames_per_second,
        clocks_per_second: Some(report.clocks as f64 / report.seconds.run),
        pixels_per_second: frames_per_second * pixels,
        build_seconds: Some(synthesis + report.seconds.build),
        passes: 1,
        seconds: report.seconds.run,
        ..LevelMeasurement::default()
    };
    let differing = u64::from(!report.passed());
    let agreement = OutputAgreement { compared: report.comparisons, differing };
    Ok(LevelRow::measured(
        BenchmarkLevel::Netlist,
        &level_name(design),
        measured.with_agreement(BenchmarkLevel::Cycle, agreement),
    ))
}

/// Returns the design for a frame of the regions of one unit, or for a smaller frame if the unit is
/// the whole array.
fn design_of_unit(design: &Design) -> Result<Design, CosimError> {
    match design.unit().array {
        ArrayStructure::RpuCopies => {
            let (side, mut config) = (design.region_size(), design.config());
            config.camera.resize_frame(side, side);
            Ok(config.validate()?)
        }
        ArrayStructure::SharedLogic => Ok(design.lone_unit()),
    }
}

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

pub(super) const RUN_TIME_LIMIT: Duration = Duration::from_secs(3600);

/// The tools of the machine, and the cache of their builds.
#[derive(Clone, Copy, Debug)]
pub struct ExternalTools<'a> {
    /// The toolchain that finds and runs the tools. Its flag stops the benchmark.
    pub toolchain: &'a Toolchain,
    /// The cache of finished builds.
    pub cache: &'a Cache,
}

#[allow(clippy::cast_precision_loss, reason = "rates need no 53 bits")]
pub(super) fn clock_rates(
    design: &Design,
    vectors: &UnpackedInputs,
    time: PassTimes,
) -> LevelMeasurement {
    let passes_per_second = time.passes as f64 / time.seconds;
    let frames_per_second = vectors.streamed_frames as f64 * passes_per_second;
    let pixels = f64::from(design.width()) * f64::from(design.height());
    LevelMeasurement {
        frames_per_second,
        clocks_per_second: Some(vectors.clocks() as f64 * passes_per_second),
        pixels_per_second: frames_per_second * pixels,
        passes: time.passes,
        seconds: time.seconds,
        ..LevelMeasurement::default()
    }
}
