// SPDX-License-Identifier: MIT OR Apache-2.0
//! Compiles and runs Verilog with Icarus. Its four-state logic shows an X that a reset leaves
//! behind.

use crate::port_widths;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::cache::Cache;
use crate::cache_key::CacheKey;
use crate::error::ToolError;
use crate::invocation::{Invocation, ProgramOutput};
use crate::source_files::{self, Source, log_excerpt};
use crate::tool::Tool;
use crate::toolchain::Toolchain;

const PROGRAM: &str = "simulation.vvp";
const COMPILE_LIMIT: Duration = Duration::from_secs(600);

/// A simulation to compile.
#[derive(Debug, Clone, Default)]
pub struct IverilogJob {
    /// The Verilog files, bench included; headers may be among them if they end in `.vh`.
    pub sources: Vec<Source>,
    /// The top module.
    pub top: String,
    /// True if any warning of `-Wall` is an error.
    pub strict: bool,
    /// A module, and the file of the bench that instantiates it. The ports of the module must have
    /// the widths of the signals that the bench connects.
    pub exact_ports: Option<(String, String)>,
    /// The macros, as `NAME` or `NAME=VALUE`.
    pub defines: Vec<String>,
}

impl IverilogJob {
    fn flags(&self) -> Vec<String> {
        let mut flags = ["-g2005", "-Wall", "-I.", "-s", &self.top].map(str::to_owned).to_vec();
        flags.extend(self.defines.iter().map(|define| format!("-D{define}")));
        flags
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.sources.iter().map(|(name, _)| name.as_str()).filter(|name| !name.ends_with(".vh"))
    }
}

/// Compiles the simulation, or finds it in the cache. Returns the program for [`run`], which stays
/// as long as the cache.
///
/// # Errors
/// Fails if Icarus is missing or rejects the sources.
pub fn compile(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &IverilogJob,
) -> Result<PathBuf, ToolError> {
    let key = CacheKey::builder("iverilog")
        .field("version", toolchain.find(Tool::Iverilog)?.identity())
        .list("flags", &job.flags())
        .field("strict", job.strict.to_string())
        .field("exact ports", format!("{:?}", job.exact_ports))
        .sources(&job.sources)
        .finish();
    cache.get_or_build(&key, PROGRAM, |dir| {
        let work = tempfile::tempdir_in(dir).map_err(ToolError::io("create a folder in", dir))?;
        source_files::write_sources(work.path(), &job.sources)?;
        let invocation = toolchain
            .invocation(Tool::Iverilog)?
            .args(job.flags())
            .arg("-o")
            .arg(dir.join(PROGRAM))
            .args(job.names())
            .dir(work.path())
            .merge_stderr()
            .timeout(COMPILE_LIMIT);
        let output = toolchain.run_checked(&invocation)?;
        if let Some((module, file)) = &job.exact_ports {
            port_widths::check_warnings(module, file, &output.log())?;
        }
        refuse_warnings(job.strict, &invocation, &output)
    })
}

/// Fails on any warning if `strict` is set. Always fails if a parameter is set that its module
/// lacks, because its value would have no effect.
fn refuse_warnings(
    strict: bool,
    invocation: &Invocation,
    output: &ProgramOutput,
) -> Result<(), ToolError> {
    let full = output.log();
    let is_missing_parameter = |line: &str| {
        let warning = line.split_once(": warning: parameter ");
        warning.is_some_and(|(_, parameter)| parameter.contains(" not found in "))
    };
    let status = if full.lines().any(is_missing_parameter) {
        "a parameter is set that its module does not have"
    } else if strict && !full.trim().is_empty() {
        "warnings count as errors"
    } else {
        return Ok(());
    };
    Err(ToolError::Failed {
        command: invocation.command_line(),
        status: status.to_owned(),
        tail: log_excerpt(&full),
        full,
        log: None,
    })
}

/// Prepares a run of a compiled simulation in a folder; `args` are plusargs such as
/// `+vectors=FILE`. The caller may add input or a time limit, and then passes the invocation to
/// [`Toolchain::run`].
///
/// # Errors
/// Fails if Icarus is missing.
pub fn invocation(
    toolchain: &Toolchain,
    program: &Path,
    args: &[String],
    dir: &Path,
) -> Result<Invocation, ToolError> {
    Ok(toolchain.invocation(Tool::Vvp)?.arg("-n").arg(program).args(args).dir(dir))
}

/// Runs a compiled simulation in a folder, whatever its exit code.
///
/// # Errors
/// Fails if Icarus is missing or the run takes longer than `limit`.
pub fn run(
    toolchain: &Toolchain,
    program: &Path,
    args: &[String],
    dir: &Path,
    limit: Duration,
) -> Result<ProgramOutput, ToolError> {
    toolchain.run(&invocation(toolchain, program, args, dir)?.timeout(limit))
}
