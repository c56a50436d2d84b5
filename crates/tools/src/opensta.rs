// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a script of OpenSTA over files from memory, and keeps what it printed.

use std::fs;
use std::path::Path;
use std::time::Duration;

use crate::cache::Cache;
use crate::cache_key::CacheKey;
use crate::error::ToolError;
use crate::source_files::{self, Source};
use crate::tool::Tool;
use crate::toolchain::Toolchain;

const SCRIPT: &str = "script.tcl";
const LOG: &str = "sta.log";
const RUN_LIMIT: Duration = Duration::from_secs(1800);

/// A script for OpenSTA.
#[derive(Debug, Clone, Default)]
pub struct OpenStaJob {
    /// The files that the script reads, by names without folders.
    pub files: Vec<Source>,
    /// The commands in Tcl, one per line.
    pub script: String,
}

/// Runs the script, or finds its result in the cache. Returns everything that OpenSTA printed.
///
/// OpenSTA prints an error of a command and goes on with the next one, so that the caller must look
/// for lines that begin with `Error`.
///
/// # Errors
/// Fails if OpenSTA is missing, ends with a failure, or takes longer than half an hour.
pub fn run(toolchain: &Toolchain, cache: &Cache, job: &OpenStaJob) -> Result<String, ToolError> {
    let key = CacheKey::builder("opensta")
        .field("version", toolchain.find(Tool::OpenSta)?.identity())
        .field("script", &job.script)
        .sources(&job.files)
        .finish();
    let log = cache.get_or_build(&key, LOG, |dir| run_in(toolchain, job, dir))?;
    let text = fs::read(&log).map_err(ToolError::io("read", &log))?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}

fn run_in(toolchain: &Toolchain, job: &OpenStaJob, dir: &Path) -> Result<(), ToolError> {
    let work = tempfile::tempdir_in(dir).map_err(ToolError::io("create a folder in", dir))?;
    source_files::write_sources(work.path(), &job.files)?;
    source_files::write_file(work.path(), SCRIPT, job.script.as_bytes())?;
    let invocation = toolchain
        .invocation(Tool::OpenSta)?
        .args(["-no_init", "-no_splash", "-exit", SCRIPT])
        .dir(work.path())
        .merge_stderr()
        .timeout(RUN_LIMIT);
    let output = toolchain.run_checked(&invocation)?;
    source_files::write_file(dir, LOG, &output.stdout)
}
