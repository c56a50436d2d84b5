// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a recording through a simulator and finds the first output that differs.

use crate::compare::{Difference, compare, parse_clocks, parse_mismatch};
use crate::error::CosimError;
use crate::harness::{bench_file, bench_name, cpp_harness, replay_bench};
use crate::recording::{ENDS_FILE, Recording, VECTORS_FILE};
use foveate_design::Port;
use foveate_emit::Parameter;
use foveate_toolchain::verilator::{self, Lint, Optimize, VerilatorJob};
use foveate_toolchain::{Cache, Invocation, Output, Source, Tool, Toolchain, iverilog};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Waves, where they are asked for.
pub(crate) const WAVES_FILE: &str = "waves.fst";

/// Registers that reset forgets must not happen to start at 0: Verilator starts them at random.
pub(crate) const UNKNOWN_START: [&str; 4] = ["--x-assign", "unique", "--x-initial", "unique"];

/// Which simulator runs the Verilog.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Simulator {
    /// Compiled and fast, two-state.
    #[default]
    Verilator,
    /// Interpreted and quick to start, four-state: an X is a mismatch.
    Iverilog,
}

impl Simulator {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Verilator, Self::Iverilog];

    /// The name, as on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Verilator => "verilator",
            Self::Iverilog => "iverilog",
        }
    }

    /// The tools that it needs.
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
pub struct Dut {
    /// Its name.
    pub top: String,
    /// Its ports.
    pub ports: Vec<Port>,
    /// Its parameters and their values.
    pub parameters: Vec<Parameter>,
    /// The Verilog: name and contents, in the order of compilation.
    pub sources: Vec<Source>,
    /// Modules that Verilator must not copy into every place that uses them.
    pub no_inline: Vec<String>,
}

/// How to simulate it.
#[derive(Clone, Debug)]
pub struct Run<'a> {
    /// With what.
    pub simulator: Simulator,
    /// Seed of the values that registers have before reset.
    pub seed: u64,
    /// Whether to write waves.
    pub trace: bool,
    /// The tools of the machine.
    pub toolchain: &'a Toolchain,
    /// Finished builds.
    pub cache: &'a Cache,
    /// The longest that the simulation itself may take.
    pub limit: Duration,
    /// How much Verilator's C++ is optimized.
    pub optimize: Optimize,
}

/// What a simulation came to.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The first difference of each port until the end of the sequence in which the first of all is, in
    /// order; nothing if all agree.
    pub differences: Vec<Difference>,
    /// Waves, if they were asked for.
    pub waves: Option<PathBuf>,
    /// Version of the simulator.
    pub version: String,
    /// Time to build the simulation, next to nothing when it is found in the cache.
    pub build: Duration,
    /// Time to simulate and compare.
    pub run: Duration,
}

impl Dut {
    /// Whether the sources have the module and its ports; the tools say so too, in other words.
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

impl Run<'_> {
    /// Builds the simulation, or finds it in the cache.
    ///
    /// # Errors
    /// When a tool is missing or refuses the sources, or the sources lack the module or a port.
    pub fn build(&self, dut: &Dut) -> Result<PathBuf, CosimError> {
        dut.check()?;
        Ok(match self.simulator {
            Simulator::Verilator => verilator::build(self.toolchain, self.cache, &self.job(dut))?,
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
    /// When there is no result; a difference is one.
    pub fn run(&self, dut: &Dut, recording: &Recording) -> Result<Outcome, CosimError> {
        let version = self.toolchain.find(self.simulator.tools()[0])?.banner;
        let start = Instant::now();
        let program = self.build(dut)?;
        let build = start.elapsed();
        let start = Instant::now();
        let folder = recording.folder_of_a_run()?;
        let waves = self.trace.then(|| folder.join(WAVES_FILE));
        let differences = match self.simulator {
            Simulator::Verilator => self.verilator(&program, recording, &folder)?,
            Simulator::Iverilog => self.iverilog(&program, recording, waves.as_deref())?,
        };
        let run = start.elapsed();
        Ok(Outcome { differences, waves, version, build, run })
    }

    pub(crate) fn job(&self, dut: &Dut) -> VerilatorJob {
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
            lint: Lint::Lenient,
            port_bits: dut.ports.iter().map(|port| (port.name.clone(), port.bits())).collect(),
            extra_args: unknown_start.into_iter().chain(parameters).collect(),
        }
    }

    fn verilator(
        &self,
        program: &Path,
        recording: &Recording,
        folder: &Path,
    ) -> Result<Vec<Difference>, CosimError> {
        let actual = folder.join("actual.bin");
        let output = self.toolchain.run(&self.harness(program, recording, &actual))?;
        if output.log().contains("cannot write the outputs") {
            let full = std::io::ErrorKind::StorageFull.into();
            return Err(CosimError::temporary("write", &actual)(full));
        }
        let compared = compare(recording, &actual)?;
        let complete = compared.records == recording.clocks() && output.is_success();
        if compared.differences.is_empty() && !complete {
            return Err(self.short(recording, compared.records, &output));
        }
        // It is as large as the recording, and other runs of the recording may follow.
        std::fs::remove_file(&actual).map_err(CosimError::temporary("remove", &actual))?;
        Ok(compared.differences)
    }

    /// The harness on the inputs of a recording; what comes out goes into `actual`, waves beside it.
    pub(crate) fn harness(
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

    fn iverilog(
        &self,
        program: &Path,
        recording: &Recording,
        waves: Option<&Path>,
    ) -> Result<Vec<Difference>, CosimError> {
        let (output, found) = self.bench(program, recording, waves)?;
        let passed = format!("PASS {} clocks", recording.clocks());
        let log = output.log();
        let Some(first) = found.first() else {
            if log.lines().any(|line| line == passed) {
                return Ok(found);
            }
            let got = log.lines().find_map(parse_clocks).unwrap_or(0);
            return Err(self.short(recording, got, &output));
        };
        let end = recording.sequence(first.clock).end;
        Ok(found.into_iter().filter(|difference| difference.clock < end).collect())
    }

    /// The replay bench on the vectors of a recording, and the first difference of each port. Waves show all
    /// vectors; without them the bench ends with the sequence of the first difference.
    fn bench(
        &self,
        program: &Path,
        recording: &Recording,
        waves: Option<&Path>,
    ) -> Result<(Output, Vec<Difference>), CosimError> {
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

    pub(crate) fn short(&self, recording: &Recording, got: u64, output: &Output) -> CosimError {
        let log = output.log();
        let tail = log.lines().rev().find(|line| !line.trim().is_empty());
        CosimError::Short {
            simulator: self.simulator.to_string(),
            clocks: recording.clocks(),
            got,
            status: output.status.clone(),
            log: tail.map(|line| format!(": {line}")).unwrap_or_default(),
        }
    }
}
