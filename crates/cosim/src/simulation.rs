// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run of a recording through a simulator, which finds the first outputs that differ.

use super::mismatch::{PortDifference, compare, parse_clocks, parse_mismatch};
use crate::error::CosimError;
use crate::harness::{bench_file, bench_name, cpp_harness, replay_bench};
use crate::recording::{ENDS_FILE, Recording, VECTORS_FILE};
use foveate_design::Port;
use foveate_emit::Parameter;
use foveate_tools::{
    Cache, Invocation, ProgramOutput, Source, Tool, Toolchain, iverilog,
    verilator::{self, LintMode, OptimizationLevel, VerilatorJob},
};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

pub(crate) const WAVES_FILE: &str = "waves.fst";

/// The options with which Verilator starts registers at random values. A register without a reset
/// must not happen to start at 0.
pub(crate) const UNKNOWN_START: [&str; 4] = ["--x-assign", "unique", "--x-initial", "unique"];

/// A simulator that runs the Verilog.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Simulator {
    /// The compiled two-state simulator, which is fast.
    #[default]
    Verilator,
    /// The interpreted four-state simulator, which starts quickly; an X is a mismatch.
    Iverilog,
}

impl Simulator {
    /// All simulators.
    pub const ALL: [Self; 2] = [Self::Verilator, Self::Iverilog];

    /// Returns the name that the command line uses.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Verilator => "verilator",
            Self::Iverilog => "iverilog",
        }
    }

    /// Returns the tools that the simulator needs.
    #[must_use]
    pub const fn tools(self) -> &'static [Tool] {
        match self {
            Self::Verilator => &[Tool::Verilator, Tool::Cxx],
            Self::Iverilog => &[Tool::Iverilog, Tool::Vvp],
        }
    }
}

impl fmt::Display for Simulator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A module under test.
#[derive(Clone, Debug)]
pub struct DesignUnderTest {
    /// The name of the module.
    pub top: String,
    /// The ports of the module.
    pub ports: Vec<Port>,
    /// The parameters of the module, with their values.
    pub parameters: Vec<Parameter>,
    /// The Verilog files, by name and contents, in the order of compilation.
    pub sources: Vec<Source>,
    /// The modules that Verilator must not copy into every place that uses them.
    pub no_inline: Vec<String>,
}

/// The settings of a simulation.
#[derive(Clone, Debug)]
pub struct SimulationRun<'a> {
    /// The simulator.
    pub simulator: Simulator,
    /// The seed of the values that registers have before reset.
    pub seed: u64,
    /// True if waves are written.
    pub trace: bool,
    /// The tools of the machine.
    pub toolchain: &'a Toolchain,
    /// The cache of finished builds.
    pub cache: &'a Cache,
    /// The longest time that the simulation itself may take.
    pub limit: Duration,
    /// The optimization of Verilator's C++.
    pub optimize: OptimizationLevel,
}

/// The result of a simulation.
#[derive(Clone, Debug)]
pub struct SimulationOutcome {
    /// The first difference of each port until the end of the sequence with the first difference,
    /// in order; empty if all values agree.
    pub differences: Vec<PortDifference>,
    /// The file with waves, if they were asked for.
    pub waves: Option<PathBuf>,
    /// The version of the simulator.
    pub version: String,
    /// The time to build the simulation; almost zero if it is found in the cache.
    pub build: Duration,
    /// The time to simulate and compare.
    pub run: Duration,
}

impl DesignUnderTest {
    /// Checks that the sources have the module and its ports, for a clearer message than those of
    /// the tools.
    fn check(&self) -> Result<(), CosimError> {
        let has = |text: &str, name: &str| {
            let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
            text.split(|c| !is_word(c)).any(|word| word == name)
        };
        let declares = |line: &str| {
            let words = line.trim_start().strip_prefix("module")?;
            let name = words.trim_start().split(|c: char| !c.is_alphanumeric() && c != '_').next();
            Some(words.starts_with(char::is_whitespace) && name == Some(self.top.as_str()))
        };
        let is_top = |source: &&Source| source.1.lines().any(|l| declares(l) == Some(true));
        let Some((_, text)) = self.sources.iter().find(is_top) else {
            let files: Vec<&str> = self.sources.iter().map(|(name, _)| name.as_str()).collect();
            let files = if files.is_empty() { "no file".to_owned() } else { files.join(", ") };
            return Err(CosimError::NoTop { top: self.top.clone(), files });
        };
        match self.ports.iter().find(|port| !has(text, &port.name)) {
            None => Ok(()),
            Some(port) => {
                Err(CosimError::NoPort { top: self.top.clone(), port: port.name.clone() })
            }
        }
    }
}

impl SimulationRun<'_> {
    /// Builds the simulation, or finds it in the cache.
    ///
    /// # Errors
    /// Fails if a tool is missing or refuses the sources, or the sources lack the module or a port.
    pub fn build(&self, dut: &DesignUnderTest) -> Result<PathBuf, CosimError> {
        dut.check()?;
        Ok(match self.simulator {
            Simulator::Verilator => {
                verilator::build(self.toolchain, self.cache, &self.verilator_job(dut))?
            }
            Simulator::Iverilog => {
                let mut sources = dut.sources.clone();
                sources.push((
                    bench_file(&dut.top),
                    replay_bench(&dut.top, &dut.ports, &dut.parameters),
                ));
                let job = iverilog::IverilogJob {
                    sources,
                    top: bench_name(&dut.top),
                    exact_ports: Some((dut.top.clone(), bench_file(&dut.top))),
                    ..Default::default()
                };
                iverilog::compile(self.toolchain, self.cache, &job)?
            }
        })
    }

    /// Builds, simulates and compares.
    ///
    /// # Errors
    /// Fails if there is no result; a difference is a result.
    pub fn run(
        &self,
        dut: &DesignUnderTest,
        recording: &Recording,
    ) -> Result<SimulationOutcome, CosimError> {
        let version = self.toolchain.find(self.simulator.tools()[0])?.banner;
        let start = Instant::now();
        let program = self.build(dut)?;
        let build = start.elapsed();
        let start = Instant::now();
        let folder = recording.create_run_folder()?;
        let waves = self.trace.then(|| folder.join(WAVES_FILE));
        let differences = match self.simulator {
            Simulator::Verilator => self.run_verilator(&program, recording, &folder)?,
            Simulator::Iverilog => self.run_iverilog(&program, recording, waves.as_deref())?,
        };
        let run = start.elapsed();
        Ok(SimulationOutcome { differences, waves, version, build, run })
    }

    pub(crate) fn verilator_job(&self, dut: &DesignUnderTest) -> VerilatorJob {
        let configure = |module| format!("no_inline -module \"{module}\"\n");
        let vlt = dut.no_inline.iter().map(configure).collect::<String>();
        let parameters = dut.parameters.iter().map(|(name, value)| format!("-G{name}={value}"));
        let unknown_start = UNKNOWN_START.map(str::to_owned);
        VerilatorJob {
            sources: dut.sources.clone(),
            top: dut.top.clone(),
            cpp_main: cpp_harness(&dut.top, &dut.ports),
            vlt: (!vlt.is_empty()).then(|| format!("`verilator_config\n{vlt}")),
            trace: self.trace,
            optimize: self.optimize,
            lint: LintMode::Lenient,
            port_bits: dut.ports.iter().map(|port| (port.name.clone(), port.bits())).collect(),
            extra_args: unknown_start.into_iter().chain(parameters).collect(),
        }
    }

    fn run_verilator(
        &self,
        program: &Path,
        recording: &Recording,
        folder: &Path,
    ) -> Result<Vec<PortDifference>, CosimError> {
        let actual = folder.join("actual.bin");
        let output = self.toolchain.run(&self.harness_invocation(program, recording, &actual))?;
        if output.log().contains("cannot write the outputs") {
            let full = std::io::ErrorKind::StorageFull.into();
            return Err(CosimError::temporary("write", &actual)(full));
        }
        let compared = compare(recording, &actual)?;
        let complete = compared.records == recording.clocks() && output.is_success();
        if compared.differences.is_empty() && !complete {
            return Err(self.short_run_error(recording, compared.records, &output));
        }
        // The file is as large as the recording, and other runs of the recording may follow.
        std::fs::remove_file(&actual).map_err(CosimError::temporary("remove", &actual))?;
        Ok(compared.differences)
    }

    /// Returns the call of the harness on the inputs of a recording. The outputs go into `actual`,
    /// and waves into the same folder.
    pub(crate) fn harness_invocation(
        &self,
        program: &Path,
        recording: &Recording,
        actual: &Path,
    ) -> Invocation {
        Invocation::new(program)
            .arg((self.seed % 0x7fff_fffe + 1).to_string())
            .arg(actual.with_file_name(WAVES_FILE))
            .dir(recording.folder())
            .stdin_file(recording.inputs_path())
            .stdout_file(actual)
            .timeout(self.limit)
    }

    fn run_iverilog(
        &self,
        program: &Path,
        recording: &Recording,
        waves: Option<&Path>,
    ) -> Result<Vec<PortDifference>, CosimError> {
        let (output, found) = self.run_bench(program, recording, waves)?;
        let passed = format!("PASS {} clocks", recording.clocks());
        let log = output.log();
        let Some(first) = found.first() else {
            if log.lines().any(|line| line == passed) {
                return Ok(found);
            }
            let got = log.lines().find_map(parse_clocks).unwrap_or(0);
            return Err(self.short_run_error(recording, got, &output));
        };
        let end = recording.sequence(first.clock).end;
        Ok(found.into_iter().filter(|difference| difference.clock < end).collect())
    }

    /// Runs the replay bench on the vectors of a recording, and returns the first difference of
    /// each port. With waves the bench plays all vectors; without them it ends with the sequence of
    /// the first difference.
    fn run_bench(
        &self,
        program: &Path,
        recording: &Recording,
        waves: Option<&Path>,
    ) -> Result<(ProgramOutput, Vec<PortDifference>), CosimError> {
        let mut args = vec![format!("+vectors={VECTORS_FILE}")];
        match waves {
            Some(waves) => {
                args.extend(["-fst".to_owned(), format!("+waves={}", waves.display())]);
            }
            None => args.push(format!("+ends={ENDS_FILE}")),
        }
        let folder = recording.bench_folder()?;
        let output = iverilog::run(self.toolchain, program, &args, folder, self.limit)?;
        let found = output.log().lines().filter_map(parse_mismatch).collect();
        Ok((output, found))
    }

    pub(crate) fn short_run_error(
        &self,
        recording: &Recording,
        got: u64,
        output: &ProgramOutput,
    ) -> CosimError {
        let log = output.log();
        let tail = log.lines().rev().find(|line| !line.trim().is_empty());
        CosimError::EndedEarly {
            simulator: self.simulator.to_string(),
            clocks: recording.clocks(),
            got,
            status: output.status.clone(),
            log: tail.map(|line| format!(": {line}")).unwrap_or_default(),
        }
    }
}
