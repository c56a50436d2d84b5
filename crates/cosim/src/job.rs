// SPDX-License-Identifier: MIT OR Apache-2.0
//! A whole co-simulation: vectors from the model, a run of the RTL, and a report.

use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::mismatch::Mismatch;
use crate::netlist::Netlist;
use crate::recording::Recording;
use crate::replay::{self, ReplaySubject};
use crate::report::{CosimReport, StepSeconds};
use crate::simulation::{DesignUnderTest, SimulationOutcome, SimulationRun, Simulator};
use crate::stimulus::Stimulus;
use foveate_camera::ConfigError;
use foveate_design::Design;
use foveate_emit::{Prefix, SourceFile, verilog};
use foveate_tools::{Cache, Source, Toolchain, sources_sha256, verilator::OptimizationLevel};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The number of regions above which the copies of an RPU or lane share their code; see
/// [`DesignUnderTest::no_inline`].
const INLINED_REGIONS: u32 = 16;

/// A co-simulation to run.
#[derive(Clone, Debug)]
pub struct CosimJob {
    /// The design.
    pub design: Design,
    /// The Verilog: the files that the emitter makes of the design, or an edited version of them.
    pub sources: Vec<SourceFile>,
    /// The prefix of the module names.
    pub prefix: Prefix,
    /// The netlist that synthesis has made of the Verilog, if it is simulated instead. Only Icarus
    /// simulates it.
    pub netlist: Option<Netlist>,
    /// The vectors.
    pub stimulus: Stimulus,
    /// The simulator.
    pub simulator: Simulator,
    /// True if waves are written.
    pub trace: bool,
    /// The folder for the replay of a failing run. A run with waves and without a mismatch writes
    /// the waves to a folder of this name, too.
    pub output: PathBuf,
    /// The longest time that the simulation itself may take.
    pub limit: Duration,
}

/// The current step of a job, for progress bars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CosimProgress {
    /// The model makes the vectors.
    Vectors {
        /// The number of sequences that are complete.
        done: u64,
        /// The number of all sequences.
        total: u64,
    },
    /// The simulation is built, simulated and compared.
    Simulation {
        /// The number of clocks to simulate.
        clocks: u64,
    },
}

impl CosimJob {
    /// Creates a job with the Verilog that the emitter makes for the level of the stimulus.
    ///
    /// # Errors
    /// Fails if the level's grid makes a frame that no design can have.
    pub fn new(design: &Design, stimulus: Stimulus, output: &Path) -> Result<Self, ConfigError> {
        let part = stimulus.level.design(design)?;
        // The array takes its grid from its parameters, so the Verilog is that of the design.
        let mut sources = verilog(design, stimulus.level.top());
        // A larger grid than the design's may elaborate more modules.
        let is_new = |file: &SourceFile| sources.iter().all(|other| other.path != file.path);
        let more: Vec<_> =
            verilog(&part, stimulus.level.top()).into_iter().filter(is_new).collect();
        sources.splice(0..0, more);
        Ok(Self {
            sources,
            prefix: Prefix::default(),
            design: design.clone(),
            netlist: None,
            stimulus,
            simulator: Simulator::default(),
            trace: false,
            output: output.to_owned(),
            limit: Duration::from_secs(3600),
        })
    }

    /// Synthesizes the Verilog to a netlist, for [`CosimJob::netlist`].
    ///
    /// # Errors
    /// Fails if Yosys is missing or refuses the Verilog, or a cell has no model.
    pub fn synthesize(&self, toolchain: &Toolchain, cache: &Cache) -> Result<Netlist, CosimError> {
        let design = self.stimulus.level.design(&self.design)?;
        let top = self.stimulus.level.top();
        Netlist::synthesize(&design, top, &self.prefix, self.named_sources(), toolchain, cache)
    }

    /// Runs the job and returns its report. A mismatch is a result and not an error.
    ///
    /// # Errors
    /// Fails if there is no result: a tool is missing or fails, a frame does not fit, a folder
    /// cannot be written, or the toolchain's flag has stopped the run. An earlier replay in the
    /// output folder is removed in any case, so a replay that is there after a run belongs to that
    /// run.
    pub fn run(
        &self,
        toolchain: &Toolchain,
        cache: &Cache,
        progress: &mut dyn FnMut(CosimProgress),
    ) -> Result<CosimReport, CosimError> {
        self.prepare(toolchain)?;
        let start = Instant::now();
        let recording = self.stimulus.record_until(
            &self.design,
            toolchain.cancel_flag(),
            &mut |done, total| progress(CosimProgress::Vectors { done, total }),
        )?;
        let vectors = start.elapsed();
        let mut report = self.simulate(&recording, toolchain, cache, progress)?;
        report.seconds.vectors = vectors.as_secs_f64();
        Ok(report)
    }

    /// Runs the job on vectors that were made before, for its design and its stimulus.
    ///
    /// # Errors
    /// Fails for the reasons that [`CosimJob::run`] lists.
    pub fn run_on(
        &self,
        recording: &Recording,
        toolchain: &Toolchain,
        cache: &Cache,
        progress: &mut dyn FnMut(CosimProgress),
    ) -> Result<CosimReport, CosimError> {
        self.prepare(toolchain)?;
        self.simulate(recording, toolchain, cache, progress)
    }

    /// Refuses a job that cannot end before anything is made, and removes the replay of an earlier
    /// run.
    fn prepare(&self, toolchain: &Toolchain) -> Result<(), CosimError> {
        self.stimulus.level.design(&self.design)?;
        replay::check_folder(&self.output)?;
        for &tool in self.simulator.tools() {
            toolchain.find(tool)?;
        }
        replay::remove_earlier(&self.output)
    }

    fn simulate(
        &self,
        recording: &Recording,
        toolchain: &Toolchain,
        cache: &Cache,
        progress: &mut dyn FnMut(CosimProgress),
    ) -> Result<CosimReport, CosimError> {
        let design = self.stimulus.level.design(&self.design)?;
        let dut = self.dut(&design);
        progress(CosimProgress::Simulation { clocks: recording.clocks() });
        let run = SimulationRun {
            simulator: self.simulator,
            seed: self.stimulus.seed,
            trace: self.trace,
            toolchain,
            cache,
            limit: self.limit,
            optimize: OptimizationLevel::FastBuild,
        };
        let outcome = run.run(&dut, recording)?;
        let mut report = self.report(&design, recording, &outcome)?;
        if let Some(mismatch) = &report.mismatch {
            let about = ReplaySubject { mismatch, fingerprint: &report.design };
            let folder =
                replay::write_replay(&self.output, &run, &dut, recording, &outcome, &about)?;
            report.replay = Some(folder);
        } else if let Some(waves) = &outcome.waves {
            report.waves = Some(replay::write_waves(&self.output, waves)?);
        }
        Ok(report)
    }

    /// Returns the name of the job for people, such as `rpu verilator`.
    #[must_use]
    pub fn name(&self) -> String {
        let netlist = if self.netlist.is_some() { " netlist" } else { "" };
        format!("{}{netlist} {}", self.stimulus.level, self.simulator)
    }

    /// Returns the Verilog in the form that the tools take.
    fn named_sources(&self) -> Vec<Source> {
        self.sources.iter().map(|file| (file.path.clone(), file.contents.clone())).collect()
    }

    /// Returns the module that is simulated; `design` is the design at the level.
    #[must_use]
    pub fn dut(&self, design: &Design) -> DesignUnderTest {
        let top = self.stimulus.level.top();
        let array = self.stimulus.level != CosimLevel::Rpu && design.regions() > INLINED_REGIONS;
        let dut = DesignUnderTest {
            top: self.prefix.prefixed_name(top.module()),
            ports: top.ports(design),
            parameters: top.parameters(design),
            sources: self.named_sources(),
            no_inline: if array {
                vec![self.prefix.prefixed_name(design.unit().module)]
            } else {
                Vec::new()
            },
        };
        match &self.netlist {
            None => dut,
            Some(Netlist { sources, .. }) => {
                DesignUnderTest { parameters: Vec::new(), sources: sources.clone(), ..dut }
            }
        }
    }

    fn report(
        &self,
        design: &Design,
        recording: &Recording,
        outcome: &SimulationOutcome,
    ) -> Result<CosimReport, CosimError> {
        let level = self.stimulus.level;
        let mismatch = Mismatch::from_differences(&outcome.differences, design, recording, level)?;
        let clocks = mismatch.as_ref().map_or(recording.clocks(), |mismatch| mismatch.clock + 1);
        Ok(CosimReport {
            name: self.name(),
            design: self.design.fingerprint(),
            level,
            grid: (design.columns(), design.rows()),
            simulator: self.simulator,
            simulator_version: outcome.version.clone(),
            rtl_sha256: sources_sha256(&self.named_sources()),
            netlist: self.netlist.as_ref().map(Netlist::to_record),
            seed: self.stimulus.seed,
            sequences: recording.sequences(),
            frames: recording.frames(),
            clocks,
            comparisons: recording.comparisons(clocks)?,
            situations: recording.situations().clone(),
            mismatch,
            replay: None,
            waves: None,
            seconds: StepSeconds {
                vectors: 0.0,
                build: outcome.build.as_secs_f64(),
                run: outcome.run.as_secs_f64(),
            },
        })
    }
}
