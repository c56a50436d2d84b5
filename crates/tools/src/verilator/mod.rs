// SPDX-License-Identifier: MIT OR Apache-2.0
//! Builds a simulator from Verilog and a C++ main, with Verilator and a C++ compiler.
//!
//! Verilator's own makefile compiles its run time anew for every model, which takes longer than a
//! small model itself. Here the run time is compiled once into the cache. Each model compiles only
//! its own files, with two compilers in parallel.

mod compiler;

use crate::port_widths;
use std::fs;
use std::path::{Path, PathBuf};

use crate::staging::ScratchFolder;

use super::port_widths::PortBits;
use crate::cache::Cache;
use crate::cache_key::CacheKey;
use crate::error::ToolError;
use crate::invocation::Invocation;
use crate::source_files::{self, Source};
use crate::tool::Tool;
use crate::toolchain::Toolchain;
pub use compiler::OptimizationLevel;
use compiler::{EXECUTABLE, LIMIT, MAIN, MakefileLists, ModelCompiler, tools_key};

const WAIVERS: &str = "waivers.vlt";

/// The treatment of questionable Verilog.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LintMode {
    /// Every warning of `-Wall` is an error.
    #[default]
    Strict,
    /// Warnings are not reported; only invalid Verilog is an error.
    Lenient,
}

impl LintMode {
    const fn flags(self) -> &'static [&'static str] {
        match self {
            Self::Strict => &["-Wall"],
            Self::Lenient => &["-Wno-fatal", "-Wno-lint", "-Wno-style"],
        }
    }
}

/// A simulator to build.
#[derive(Debug, Clone, Default)]
pub struct VerilatorJob {
    /// The Verilog files; headers for `` `include `` may be among them if they end in `.vh`.
    pub sources: Vec<Source>,
    /// The top module. The C++ class is this name after a `V`, and its header is `V<top>.h`.
    pub top: String,
    /// The C++ source with `main`.
    pub cpp_main: String,
    /// A Verilator configuration, for lint waivers and `no_inline`.
    pub vlt: Option<String>,
    /// True if the model can write FST waves.
    pub trace: bool,
    /// The optimization level of the C++ compiler.
    pub optimize: OptimizationLevel,
    /// The treatment of questionable Verilog.
    pub lint: LintMode,
    /// The ports of the top module whose widths are checked, with these widths.
    pub port_bits: Vec<PortBits>,
    /// Further arguments of Verilator, such as `--assert`.
    pub extra_args: Vec<String>,
}

/// Builds the simulator, or finds it in the cache. Returns its executable.
///
/// # Errors
/// Fails if a tool is missing, or if Verilator or the compiler rejects the sources.
pub fn build(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &VerilatorJob,
) -> Result<PathBuf, ToolError> {
    let key = job.cache_key(toolchain)?;
    cache.get_or_build(&key, EXECUTABLE, |dir| {
        let work = tempfile::tempdir_in(dir).map_err(ToolError::io("create a folder in", dir))?;
        let built = build_in(toolchain, cache, job, work.path())?;
        let target = dir.join(EXECUTABLE);
        fs::rename(&built, &target).map_err(ToolError::io("write", &target))
    })
}

/// Returns whether the simulator is in the cache, so that [`build`] would take no time.
///
/// # Errors
/// Fails if a tool is missing.
pub fn is_built(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &VerilatorJob,
) -> Result<bool, ToolError> {
    Ok(cache.contains(&job.cache_key(toolchain)?, EXECUTABLE))
}

/// Runs Verilator's lint over the sources.
///
/// # Errors
/// Fails if Verilator is missing or reports anything.
pub fn lint(
    toolchain: &Toolchain,
    sources: &[Source],
    top: &str,
    vlt: Option<&str>,
) -> Result<(), ToolError> {
    let dir = ScratchFolder::new()
        .map_err(ToolError::temporary("create a folder in", &std::env::temp_dir()))?;
    let args = ["--lint-only", "--no-timing", "-Wall", "--top-module", top];
    let invocation = toolchain.invocation(Tool::Verilator)?.args(args);
    let invocation = with_sources(invocation, dir.path(), sources, vlt)?;
    toolchain.run_checked(&invocation).map(drop)
}

/// Returns the hierarchy below `top` with these parameters, as Verilator's XML. It has every module
/// with the values of its parameters, without `generate` branches that are not taken.
///
/// # Errors
/// Fails if Verilator is missing or rejects the sources.
pub fn elaborate(
    toolchain: &Toolchain,
    sources: &[Source],
    top: &str,
    parameters: &[(&str, u32)],
) -> Result<Vec<u8>, ToolError> {
    const HIERARCHY: &str = "hierarchy.xml";
    let dir = ScratchFolder::new()
        .map_err(ToolError::temporary("create a folder in", &std::env::temp_dir()))?;
    let parameters = parameters.iter().map(|(name, value)| format!("-G{name}={value}"));
    let invocation = toolchain
        .invocation(Tool::Verilator)?
        .args(["--xml-only", "--xml-output", HIERARCHY, "--no-timing", "--top-module", top])
        // By default Verilator treats a loop of more than 1,024 iterations as endless.
        .args(["--unroll-count", "1000000"])
        .args(LintMode::Lenient.flags())
        .args(parameters);
    let invocation = with_sources(invocation, dir.path(), sources, None)?;
    toolchain.run_checked(&invocation)?;
    let written = dir.path().join(HIERARCHY);
    fs::read(&written).map_err(ToolError::io("read", &written))
}

impl VerilatorJob {
    fn cache_key(&self, toolchain: &Toolchain) -> Result<CacheKey, ToolError> {
        let key = tools_key("verilator", toolchain)?
            .list("flags", &self.flags())
            .list("compiler flags", &compiler::header_flags(self.trace))
            .field("port bits", format!("{:?}", self.port_bits))
            .field("optimize", self.optimize.flag())
            .field("main", &self.cpp_main)
            .field("vlt", self.vlt.as_deref().unwrap_or_default());
        Ok(key.sources(&self.sources).finish())
    }

    fn flags(&self) -> Vec<String> {
        let mut flags = vec!["--cc", "--no-timing", "-O3", "--output-split", "20000"];
        flags.extend(["--Mdir", ".", "--top-module", &self.top]);
        flags.extend(self.lint.flags());
        if self.trace {
            flags.push("--trace-fst");
        }
        let mut flags: Vec<String> = flags.into_iter().map(str::to_owned).collect();
        flags.extend(["--prefix".to_owned(), self.prefix()]);
        flags.extend(self.extra_args.iter().cloned());
        flags
    }

    fn prefix(&self) -> String {
        format!("V{}", self.top)
    }
}

fn build_in(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &VerilatorJob,
    dir: &Path,
) -> Result<PathBuf, ToolError> {
    let invocation = toolchain.invocation(Tool::Verilator)?.args(job.flags());
    let invocation = with_sources(invocation, dir, &job.sources, job.vlt.as_deref())?;
    toolchain.run_checked(&invocation)?;
    let header = dir.join(format!("{}.h", job.prefix()));
    let header = fs::read_to_string(&header).map_err(ToolError::io("read", &header))?;
    port_widths::check_header(&job.top, &header, &job.port_bits)?;
    source_files::write_file(dir, MAIN, job.cpp_main.as_bytes())?;
    let makefile = MakefileLists::read(dir, &job.prefix())?;
    let compiler = ModelCompiler::new(toolchain, &makefile.include, job.trace)?;
    // The model is compiled first, because only its sources may have mistakes.
    let mut objects = compiler.compile_model(cache, dir, &makefile, job.optimize)?;
    objects.extend(compiler.compile_run_time(cache, &makefile)?);
    compiler.link(dir, &objects, &makefile)
}

/// Writes the sources into `dir` and adds their names as arguments. Headers are not named, because
/// Verilator finds them.
fn with_sources(
    invocation: Invocation,
    dir: &Path,
    sources: &[Source],
    vlt: Option<&str>,
) -> Result<Invocation, ToolError> {
    source_files::write_sources(dir, sources)?;
    let mut invocation = invocation.dir(dir).merge_stderr().timeout(LIMIT);
    if let Some(vlt) = vlt {
        source_files::write_file(dir, WAIVERS, vlt.as_bytes())?;
        invocation = invocation.arg(WAIVERS);
    }
    let names = sources.iter().map(|(name, _)| name).filter(|name| !name.ends_with(".vh"));
    Ok(invocation.args(names))
}
