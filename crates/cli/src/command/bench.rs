// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate bench`: the same frames through every level of a design, with the cost of each level
//! and a comparison.

mod table;

use std::time::Duration;

use foveate_cosim::{Benchmark, ExternalTools, random_frames};
use foveate_design::Design;
use foveate_pixels::Frame;
use foveate_simulator::SimulatorError;
use foveate_tools::Cache;

use crate::args::BenchArgs;
use crate::error::CliError;
use crate::progress::Progress;
use crate::{interrupt, output};

pub(crate) fn run(args: &BenchArgs) -> Result<(), CliError> {
    let (design, frames) = design_and_frames(args)?;
    let (toolchain, cache) = (interrupt::toolchain()?, Cache::from_env()?);
    let bench = Benchmark {
        design,
        frames,
        seed: args.seed,
        min_time: Duration::from_secs_f64(args.seconds),
        runs_netlist: args.netlist,
    };
    let progress = Progress::new(args.quiet);
    let tools = ExternalTools { toolchain: &toolchain, cache: &cache };
    let report = bench.run(tools, &mut |level| progress.report_work(level));
    progress.finish();
    let report = report?;
    output::print_result((args.json, false), &report, || match args.markdown {
        true => table::markdown(&report),
        false => table::text(&report, output::text_width()),
    })?;
    match report.differing_values() {
        0 => Ok(()),
        differing => Err(CliError::Failed(format!("the levels differ in {differing} values"))),
    }
}

fn design_and_frames(args: &BenchArgs) -> Result<(Design, Vec<Frame>), CliError> {
    let (design, frames) = args.design.with_frames(&args.inputs, args.frames)?;
    if !args.inputs.is_empty() {
        return Ok((design, frames));
    }
    let frames = random_frames(&design, args.seed, args.frames).map_err(SimulatorError::from)?;
    Ok((design, frames))
}
