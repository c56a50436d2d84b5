// SPDX-License-Identifier: MIT OR Apache-2.0
//! The benchmark, which runs one level after the other.

use std::time::Duration;

use foveate_cosim::{CosimError, Level as Simulated, Recording, Stimulus};
use foveate_design::Design;
use foveate_frame::Frame;
use foveate_toolchain::{Tool, Toolchain};

use crate::error::BenchError;
use crate::report::{BenchReport, FORMAT_VERSION, Level, LevelRow};
use crate::timer::Timer;
use crate::tools::Tools;
use crate::vectors::Vectors;
use crate::{cycle, functional, netlist, rtl};

/// The parameters of a benchmark.
#[derive(Clone, Debug)]
pub struct Bench {
    /// The design.
    pub design: Design,
    /// The frames, with the size and depth of the design.
    pub frames: Vec<Frame>,
    /// The seed of the values at the ports while no pixel is valid.
    pub seed: u64,
    /// The shortest time for which each level is timed. At least one pass is done.
    pub at_least: Duration,
    /// Runs the netlist, too.
    pub netlist: bool,
}

impl Bench {
    /// Runs every level. `progress` is called with the name of each step before it begins.
    ///
    /// # Errors
    /// Fails if there is no result. A missing tool gives a row that says so, and differences are a
    /// result.
    pub fn run(
        &self,
        tools: Tools<'_>,
        progress: &mut dyn FnMut(&str),
    ) -> Result<BenchReport, BenchError> {
        if self.frames.is_empty() {
            return Err(BenchError::NoFrames);
        }
        let Self { design, frames, .. } = self;
        let timer = Timer { at_least: self.at_least, cancel: tools.toolchain.cancel_flag() };
        progress("functional levels");
        let mut rows = vec![
            functional::clear(design, frames, timer)?,
            functional::fast(design, frames, timer)?,
        ];
        progress("vectors");
        let recording = self.record(timer)?;
        let vectors = Vectors::read(design, &recording)?;
        progress("cycle-level model");
        rows.push(cycle::cycle(design, frames, &recording, &vectors, timer)?);
        progress("RTL: building and running Verilator's model");
        rows.push(match missing(tools.toolchain, &[Tool::Verilator, Tool::Cxx])? {
            Some(why) => LevelRow::missing(Level::Rtl, "Verilator", why),
            None => rtl::rtl(design, &recording, &vectors, tools, timer)?,
        });
        if self.netlist {
            progress("netlist: Yosys and Icarus");
            let needed = [Tool::Yosys, Tool::Iverilog, Tool::Vvp];
            rows.push(match missing(tools.toolchain, &needed)? {
                Some(why) => LevelRow::missing(Level::Netlist, &netlist::name(design), why),
                None => netlist::netlist(design, frames, self.seed, tools)?,
            });
        }
        let mut report = self.report(&vectors, rows);
        report.relate();
        Ok(report)
    }

    /// Records the vectors of all levels with clocks: the frames without gaps, with a pixel at
    /// every clock.
    fn record(&self, timer: Timer<'_>) -> Result<Recording, BenchError> {
        let frames = self.frames.clone();
        let stimulus =
            Stimulus { level: Simulated::Full, seed: self.seed, rounds: 0, frames, enough: None };
        Ok(stimulus.record_until(&self.design, timer.cancel, &mut |_, _| {})?)
    }

    fn report(&self, vectors: &Vectors, rows: Vec<LevelRow>) -> BenchReport {
        let design = &self.design;
        BenchReport {
            format_version: FORMAT_VERSION,
            design: design.fingerprint(),
            organization: design.organization().name(),
            regions: design.regions(),
            size: (design.width(), design.height()),
            frames: self.frames.len() as u64,
            streamed: vectors.streamed,
            clocks: vectors.clocks(),
            instructions: foveate_engine::Level::detect().name().to_owned(),
            rows,
        }
    }
}

/// Returns the reason why a level cannot run, if a tool that it needs is missing or too old.
fn missing(toolchain: &Toolchain, needed: &[Tool]) -> Result<Option<String>, BenchError> {
    for &tool in needed {
        match toolchain.find(tool) {
            Ok(_) => {}
            Err(error) if error.is_interrupted() => return Err(CosimError::from(error).into()),
            Err(error) => return Ok(Some(error.to_string())),
        }
    }
    Ok(None)
}
