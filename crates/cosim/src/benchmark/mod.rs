// SPDX-License-Identifier: MIT OR Apache-2.0
//! A benchmark: the same frames run through every level of a design. The result is the cost of each
//! level, and whether the levels agree.
//!
//! A [`Benchmark`] goes from whole frames down to gates. Each level runs on one thread, one after
//! the other, and is compared with a level above it:
//!
//! | level | implementation | steps | comparison |
//! | --- | --- | --- | --- |
//! | functional, clear | `FunctionalCamera` | frames | none: it is the reference |
//! | functional, fast | `Engine` | frames | every result of every region, with `FunctionalCamera` |
//! | transactions | `TimedModel` | frames | decisions and words at their clocks, with the cycle level |
//! | cycle | `PipelinedRcm` and others | clocks | scores and decisions, with `FunctionalCamera` |
//! | RTL | Verilator | clocks | every port at every clock, with the cycle level |
//! | netlist | Icarus, one RPU | clocks | every port at every clock, with the cycle level |
//!
//! The levels with clocks take the same [`Recording`]. Each level is first compared, in a separate
//! pass, and then timed from memory, without files, comparison or reading of outputs.

mod benchmark_report;
mod functional_levels;
mod netlist_level;
mod outcome_comparison;
mod pass_timer;
#[cfg(test)]
mod planted_differences;
mod unpacked_inputs;

pub use benchmark_report::{
    BENCHMARK_FORMAT_VERSION, BenchmarkLevel, BenchmarkReport, LevelMeasurement, LevelRow,
};
pub use netlist_level::ExternalTools;
pub use unpacked_inputs::random_frames;

use std::time::Duration;

use foveate_design::Design;
use foveate_pixels::Frame;
use foveate_tools::{Tool, Toolchain};

use self::pass_timer::PassTimer;
use self::unpacked_inputs::UnpackedInputs;
use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::recording::Recording;
use crate::stimulus::Stimulus;

/// The parameters of a benchmark.
#[derive(Clone, Debug)]
pub struct Benchmark {
    /// The design.
    pub design: Design,
    /// The frames, with the size and depth of the design.
    pub frames: Vec<Frame>,
    /// The seed of the values at the ports while no pixel is valid.
    pub seed: u64,
    /// The shortest time for which each level is timed. At least one pass is done.
    pub min_time: Duration,
    /// Runs the netlist, too.
    pub runs_netlist: bool,
}

impl Benchmark {
    /// Runs every level. `progress` is called with the name of each step before it begins.
    ///
    /// # Errors
    /// Fails if there is no result. A missing tool gives a row that says so, and differences are a
    /// result.
    pub fn run(
        &self,
        tools: ExternalTools<'_>,
        progress: &mut dyn FnMut(&str),
    ) -> Result<BenchmarkReport, CosimError> {
        if self.frames.is_empty() {
            return Err(CosimError::NoFrames);
        }
        let Self { design, frames, .. } = self;
        let timer = PassTimer { min_time: self.min_time, cancel: tools.toolchain.cancel_flag() };
        progress("functional levels");
        let mut rows = vec![
            functional_levels::run_model(design, frames, timer)?,
            functional_levels::run_engine(design, frames, timer)?,
        ];
        progress("vectors");
        let recording = self.record_vectors(timer)?;
        let vectors = UnpackedInputs::read(design, &recording)?;
        progress("timed model");
        rows.push(functional_levels::run_transaction_level(
            design, frames, &recording, &vectors, timer,
        )?);
        progress("cycle-level model");
        rows.push(functional_levels::run_cycle_level(design, frames, &recording, &vectors, timer)?);
        progress("RTL: building and running Verilator's model");
        rows.push(match missing_tool(tools.toolchain, &[Tool::Verilator, Tool::Cxx])? {
            Some(why) => LevelRow::not_run(BenchmarkLevel::Rtl, "Verilator", why),
            None => netlist_level::run_rtl(design, &recording, &vectors, tools, timer)?,
        });
        if self.runs_netlist {
            progress("netlist: Yosys and Icarus");
            let needed = [Tool::Yosys, Tool::Iverilog, Tool::Vvp];
            rows.push(match missing_tool(tools.toolchain, &needed)? {
                Some(why) => LevelRow::not_run(
                    BenchmarkLevel::Netlist,
                    &netlist_level::level_name(design),
                    why,
                ),
                None => netlist_level::run_netlist(design, frames, self.seed, tools)?,
            });
        }
        let mut report = self.make_report(&vectors, rows);
        report.fill_in_ratios();
        Ok(report)
    }

    /// Records the vectors of all levels with clocks: the frames without gaps, with a pixel at
    /// every clock.
    fn record_vectors(&self, timer: PassTimer<'_>) -> Result<Recording, CosimError> {
        let frames = self.frames.clone();
        let stimulus = Stimulus {
            level: CosimLevel::Full,
            seed: self.seed,
            rounds: 0,
            frames,
            sufficient_clocks: None,
        };
        stimulus.record_until(&self.design, timer.cancel, &mut |_, _| {})
    }

    fn make_report(&self, vectors: &UnpackedInputs, rows: Vec<LevelRow>) -> BenchmarkReport {
        let design = &self.design;
        BenchmarkReport {
            format_version: BENCHMARK_FORMAT_VERSION,
            design: design.fingerprint(),
            organization: design.organization().name(),
            regions: design.regions(),
            size: (design.width(), design.height()),
            frames: self.frames.len() as u64,
            streamed_frames: vectors.streamed_frames,
            clocks: vectors.clocks(),
            instructions: foveate_engine::InstructionSet::detect().name().to_owned(),
            rows,
        }
    }
}

/// Returns the reason why a level cannot run, if a tool that it needs is missing or too old.
fn missing_tool(toolchain: &Toolchain, needed: &[Tool]) -> Result<Option<String>, CosimError> {
    for &tool in needed {
        match toolchain.find(tool) {
            Ok(_) => {}
            Err(error) if error.is_interrupted() => return Err(error.into()),
            Err(error) => return Ok(Some(error.to_string())),
        }
    }
    Ok(None)
}
