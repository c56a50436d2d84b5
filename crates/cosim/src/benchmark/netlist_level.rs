// SPDX-License-Identifier: MIT OR Apache-2.0
//! The netlist that Yosys makes of one RPU, of one serial lane, or of a small raster core,
//! simulated in Icarus with the first regions of the same frames.

use foveate_tools::ScratchFolder;
use std::time::Instant;

use foveate_design::{ArrayStructure, Design};
use foveate_pixels::Frame;

use super::benchmark_report::{BenchmarkLevel, LevelMeasurement, LevelRow};
use super::external_tools::{ExternalTools, RUN_TIME_LIMIT};
use crate::error::CosimError;
use crate::job::CosimJob;
use crate::level::CosimLevel;
use crate::simulation::Simulator;
use crate::stimulus::Stimulus;
use crate::timed_run::OutputAgreement;

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
