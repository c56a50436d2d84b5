// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a Yosys script over sources from memory ([`run`]), and keeps its log and the files that
//! it wrote.

use crate::cache::Cache;
use crate::cache_key::CacheKey;
use crate::error::ToolError;
use crate::source_files::{self, Source, log_excerpt};
use crate::tool::Tool;
use crate::toolchain::Toolchain;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::time::Duration;

const SCRIPT: &str = "script.ys";

const LOG: &str = "yosys.log";

const LIMIT: Duration = Duration::from_secs(1800);

/// A Yosys script to run.
#[derive(Debug, Clone, Default)]
pub struct YosysJob {
    /// The Verilog files; the script reads them by these names.
    pub sources: Vec<Source>,
    /// The commands, one per line.
    pub script: String,
    /// The files that the script writes and that are returned; names without folders.
    pub outputs: Vec<String>,
}

/// The results of a script.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct YosysResult {
    /// Everything that Yosys printed.
    pub log: String,
    /// The requested files by name.
    pub files: BTreeMap<String, Vec<u8>>,
}

/// Runs the script, or finds its results in the cache.
///
/// # Errors
/// Fails if Yosys is missing, if the script fails, or if a requested file was not written.
pub fn run(toolchain: &Toolchain, cache: &Cache, job: &YosysJob) -> Result<YosysResult, ToolError> {
    let key = CacheKey::builder("yosys")
        .field("version", toolchain.find(Tool::Yosys)?.identity())
        .field("script", &job.script)
        .list("outputs", &job.outputs)
        .sources(&job.sources)
        .finish();
    let log = cache.get_or_build(&key, LOG, |dir| run_in(toolchain, job, dir))?;
    let dir = log.parent().expect("the log lies in the folder of its entry");
    let read = |name: &str| {
        let path = dir.join(name);
        fs::read(&path).map_err(ToolError::io("read", &path))
    };
    let mut files = BTreeMap::new();
    for name in &job.outputs {
        let contents = read(name)?;
        check_json(name, &contents, dir)?;
        files.insert(name.clone(), contents);
    }
    Ok(YosysResult { log: String::from_utf8_lossy(&read(LOG)?).into_owned(), files })
}

/// Returns a file of cell models from the library of Yosys, such as `xilinx/cells_sim.v`. The log
/// of Yosys has the path of the file.
///
/// # Errors
/// Fails if Yosys is missing, if its library has no such file, or if this process cannot read the
/// file, as for a Yosys that brings its own file system.
pub fn cell_models(toolchain: &Toolchain, cache: &Cache, file: &str) -> Result<String, ToolError> {
    let script = format!("read_verilog -lib +/{file}\n");
    let run = run(toolchain, cache, &YosysJob { script, ..YosysJob::default() })?;
    let path = run.log.lines().find_map(|line| {
        line.strip_prefix("Parsing Verilog input from `")?.split_once('\'').map(|(path, _)| path)
    });
    let not_found = ToolError::io("find in the library of Yosys", Path::new(file));
    let path = Path::new(path.ok_or_else(|| not_found(ErrorKind::NotFound.into()))?);
    fs::read_to_string(path).map_err(ToolError::io("read the cell models of Yosys in", path))
}

/// Returns the text of the module of that name in a file of models, if the file has one.
#[must_use]
pub fn module_text(library: &str, name: &str) -> Option<String> {
    let is_start = |line: &str| {
        let rest = line.strip_prefix("module ").and_then(|rest| rest.strip_prefix(name));
        rest.is_some_and(|rest| rest.trim_start().starts_with(['(', '#', ';']) || rest.is_empty())
    };
    let mut lines = library.lines().skip_while(|line| !is_start(line)).peekable();
    lines.peek()?;
    let mut text = String::new();
    for line in lines {
        text += line;
        text.push('\n');
        if line.starts_with("endmodule") {
            break;
        }
    }
    Some(text)
}

/// Fails on JSON that is invalid or empty. A Yosys that was killed may write such a file, and
/// another program that is installed under its name may do so, too.
fn check_json(name: &str, contents: &[u8], folder: &Path) -> Result<(), ToolError> {
    if !name.ends_with(".json") {
        return Ok(());
    }
    let reason = match serde_json::from_slice::<Value>(contents) {
        Ok(Value::Object(object)) if object.is_empty() => "it is empty JSON".to_owned(),
        Ok(_) => return Ok(()),
        Err(error) => format!("it is not JSON: {error}"),
    };
    Err(ToolError::Unusable { path: folder.join(name), folder: folder.to_owned(), reason })
}

fn run_in(toolchain: &Toolchain, job: &YosysJob, dir: &Path) -> Result<(), ToolError> {
    let work = tempfile::tempdir_in(dir).map_err(ToolError::io("create a folder in", dir))?;
    source_files::write_sources(work.path(), &job.sources)?;
    source_files::write_file(work.path(), SCRIPT, job.script.as_bytes())?;
    let invocation = toolchain
        .invocation(Tool::Yosys)?
        .args(["-Q", "-T", "-s", SCRIPT])
        .dir(work.path())
        .merge_stderr()
        .timeout(LIMIT);
    let output = toolchain.run_checked(&invocation)?;
    source_files::write_file(dir, LOG, &output.stdout)?;
    for name in &job.outputs {
        let written = work.path().join(name);
        if !written.is_file() {
            return Err(ToolError::MissingOutput {
                command: invocation.command_line(),
                file: name.clone(),
                tail: log_excerpt(&output.log()),
            });
        }
        check_json(name, &fs::read(&written).map_err(ToolError::io("read", &written))?, dir)?;
        let target = dir.join(name);
        fs::rename(&written, &target).map_err(ToolError::io("write", &target))?;
    }
    Ok(())
}
