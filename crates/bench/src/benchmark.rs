// SPDX-License-Identifier: MIT OR Apache-2.0
//! The benchmark, which runs one level after the other.

use std::time::Duration;

use foveate_cosim::{CosimError, CosimLevel as Simulated, Recording, Stimulus};
use foveate_design::Design;
use foveate_frame::Frame;
use foveate_toolchain::{Tool, Toolchain};

use crate::error::BenchmarkError;
use crate::report::{BenchmarkLevel, BenchmarkReport, FORMAT_VERSION, LevelRow};
use crate::timer::PassTimer;
use crate::tools::ExternalTools;
use crate::vectors::UnpackedInputs;
use crate::{cycle_level, functional_levels, netlist_level, rtl_level};

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
    ) -> Result<BenchmarkReport, BenchmarkError> {
        if self.frames.is_empty() {
            return Err(BenchmarkError::NoFrames);
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
        progress("cycle-level model");
        rows.push(cycle_level::run_cycle_level(design, frames, &recording, &vectors, timer)?);
        progress("RTL: building and running Verilator's model");
        rows.push(match missing_tool(tools.toolchain, &[Tool::Verilator, Tool::Cxx])? {
            Some(why) => LevelRow::not_run(BenchmarkLevel::Rtl, "Verilator", why),
            None => rtl_level::run_rtl(design, &recording, &vectors, tools, timer)?,
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
    fn record_vectors(&self, timer: PassTimer<'_>) -> Result<Recording, BenchmarkError> {
        let frames = self.frames.clone();
        let stimulus = Stimulus {
            level: Simulated::Full,
            seed: self.seed,
            rounds: 0,
            frames,
            sufficient_clocks: None,
        };
        Ok(stimulus.record_until(&self.design, timer.cancel, &mut |_, _| {})?)
    }

    fn make_report(&self, vectors: &UnpackedInputs, rows: Vec<LevelRow>) -> BenchmarkReport {
        let design = &self.design;
        BenchmarkReport {
            format_version: FORMAT_VERSION,
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
fn missing_tool(toolchain: &Toolchain, needed: &[Tool]) -> Result<Option<String>, BenchmarkError> {
    for &tool in needed {
        match toolchain.find(tool) {
            Ok(_) => {}
            Err(error) if error.is_interrupted() => return Err(CosimError::from(error).into()),
            Err(error) => return Ok(Some(error.to_string())),
        }
    }
    Ok(None)
}
