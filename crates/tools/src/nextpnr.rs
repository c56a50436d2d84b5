// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places and routes a netlist with nextpnr, and keeps its report and its log.

use std::fs;
use std::path::Path;
use std::time::Duration;

use crate::cache::Cache;
use crate::cache_key::CacheKey;
use crate::error::ToolError;
use crate::source_files::{self, log_excerpt};
use crate::tool::Tool;
use crate::toolchain::Toolchain;

const NETLIST: &str = "netlist.json";
const REPORT: &str = "report.json";
const RUN_LIMIT: Duration = Duration::from_secs(3600);

/// A netlist to place and route.
#[derive(Debug, Clone)]
pub struct NextpnrJob {
    /// The variant of nextpnr for the device's family.
    pub tool: Tool,
    /// The arguments that choose the device, and further arguments.
    pub args: Vec<String>,
    /// A file that the arguments name, with its text.
    pub extra_file: Option<(&'static str, String)>,
    /// The seed of the placement.
    pub seed: u32,
    /// The netlist in the JSON format of Yosys.
    pub netlist: Vec<u8>,
}

/// Places and routes a netlist, or finds the result in the cache. Returns the report that nextpnr
/// writes as JSON.
///
/// # Errors
/// Fails if nextpnr is missing or fails; the log in [`ToolError::Failed`] then says what the device
/// lacks.
pub fn run(toolchain: &Toolchain, cache: &Cache, job: &NextpnrJob) -> Result<Vec<u8>, ToolError> {
    let beside: Vec<_> =
        job.extra_file.iter().flat_map(|(name, text)| [(*name).to_owned(), text.clone()]).collect();
    let key = CacheKey::builder("nextpnr")
        .field("version", toolchain.find(job.tool)?.identity())
        .list("arguments", &job.args)
        .field("seed", job.seed.to_string())
        .field("netlist", &job.netlist)
        .list("beside", &beside)
        .finish();
    let report = cache.get_or_build(&key, REPORT, |dir| run_in(toolchain, job, dir))?;
    fs::read(&report).map_err(ToolError::io("read", &report))
}

/// Runs nextpnr in a working folder. File names have no folders, because the builds for WebAssembly
/// see only some of the folders of the machine.
fn run_in(toolchain: &Toolchain, job: &NextpnrJob, dir: &Path) -> Result<(), ToolError> {
    let work = tempfile::tempdir_in(dir).map_err(ToolError::io("create a folder in", dir))?;
    source_files::write_file(work.path(), NETLIST, &job.netlist)?;
    if let Some((name, text)) = &job.extra_file {
        source_files::write_file(work.path(), name, text.as_bytes())?;
    }
    let seed = job.seed.to_string();
    let invocation = toolchain
        .invocation(job.tool)?
        .args(&job.args)
        .args(["--json", NETLIST, "--report", REPORT, "--seed", &seed])
        .dir(work.path())
        .merge_stderr()
        .timeout(RUN_LIMIT);
    let output = toolchain.run_checked(&invocation)?;
    let written = work.path().join(REPORT);
    if !written.is_file() {
        return Err(ToolError::MissingOutput {
            command: invocation.command_line(),
            file: REPORT.to_owned(),
            tail: log_excerpt(&output.log()),
        });
    }
    let kept = dir.join(REPORT);
    fs::rename(&written, &kept).map_err(ToolError::io("write", &kept))
}
