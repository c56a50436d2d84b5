// SPDX-License-Identifier: MIT OR Apache-2.0
//! Helpers for tests: skips where a tool or data is missing, the choice of designs for slow tests,
//! and a mock machine with scripted tools.

mod cover;

pub use cover::cover;

use std::collections::HashMap;
use std::ffi::OsString;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::error::ToolError;
use crate::host::Host;
use crate::invocation::{Invocation, ProgramOutput};
use crate::tool::Tool;
use crate::toolchain::Toolchain;

/// Returns whether a test that needs these tools can run. If not, prints a message that the test
/// harness does not capture.
///
/// # Panics
/// Panics if a tool cannot be used and the environment variable `FOVEATE_REQUIRE_TOOLS` is `1`, so
/// that a test server does not skip tests silently.
#[must_use]
pub fn require_tools(tools: &[Tool]) -> bool {
    let toolchain = Toolchain::system();
    let Some(error) = tools.iter().find_map(|&tool| toolchain.find(tool).err()) else {
        return true;
    };
    assert!(!is_strict(), "FOVEATE_REQUIRE_TOOLS is 1, but {error}");
    report_skip(&error.to_string());
    false
}

/// Returns whether slow tests run over whole lists and not over a part of them. The environment
/// variable `FOVEATE_WHOLE` selects this; `scripts/release.sh` sets it.
#[must_use]
pub fn takes_whole_lists() -> bool {
    std::env::var_os("FOVEATE_WHOLE").is_some()
}

/// Returns the step through a list for tests that need only every `n`-th item in most runs.
#[must_use]
pub fn sampling_step(n: usize) -> usize {
    if takes_whole_lists() { 1 } else { n }
}

/// Returns every `n`-th item of a list in most runs, beginning with the first, and all of them if
/// tests take whole lists.
#[must_use]
pub fn sample<T>(items: impl IntoIterator<Item = T>, n: usize) -> Vec<T> {
    items.into_iter().step_by(sampling_step(n)).collect()
}

/// Returns the folder of real images and video that the environment variable `FOVEATE_DATA` names.
/// Without it, prints that the test is skipped.
///
/// # Panics
/// Panics if the variable does not name a folder and `FOVEATE_REQUIRE_TOOLS` is `1`. A test itself
/// must fail if a file is missing in the folder.
#[must_use]
pub fn data_folder() -> Option<PathBuf> {
    named_folder(std::env::var_os("FOVEATE_DATA"), is_strict())
}

fn named_folder(named: Option<OsString>, strict: bool) -> Option<PathBuf> {
    let Some(path) = named.filter(|name| !name.is_empty()).map(PathBuf::from) else {
        report_skip("FOVEATE_DATA is not set");
        return None;
    };
    if path.is_dir() {
        return Some(path);
    }
    let problem = format!("FOVEATE_DATA is `{}`, which is not a folder", path.display());
    assert!(!strict, "FOVEATE_REQUIRE_TOOLS is 1, but {problem}");
    report_skip(&problem);
    None
}

/// Returns whether tests that lack a tool or data fail instead of being skipped.
fn is_strict() -> bool {
    std::env::var_os("FOVEATE_REQUIRE_TOOLS").is_some_and(|value| value == "1")
}

/// Prints that a test is skipped, and why, so that the test harness does not capture it.
pub fn report_skip(reason: &str) {
    let name = std::thread::current().name().unwrap_or("test").to_owned();
    // A single write keeps the lines of concurrent tests apart. A failed write to the terminal is
    // ignored.
    let line = format!("\nSKIPPED {name}: {reason}\n");
    let _ = std::io::stderr().write_all(line.as_bytes());
}

type RunHandler = Box<dyn Fn(&Invocation) -> Result<ProgramOutput, ToolError> + Send + Sync>;

/// A machine with scripted tools, whose `PATH` is `/opt/bin`.
#[derive(Default)]
pub struct MockHost {
    variables: HashMap<String, OsString>,
    tools: HashMap<PathBuf, String>,
    run_handler: Option<RunHandler>,
    log: MockLog,
}

/// The commands that a [`MockHost`] has run.
#[derive(Debug, Clone, Default)]
pub struct MockLog(Arc<Mutex<Vec<String>>>);

impl MockLog {
    /// Returns the command lines in order.
    #[must_use]
    pub fn commands(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl MockHost {
    /// Makes a machine without any tool.
    #[must_use]
    pub fn new() -> Self {
        Self::default().variable("PATH", "/opt/bin")
    }

    /// Sets an environment variable.
    #[must_use]
    pub fn variable(mut self, name: &str, value: &str) -> Self {
        self.variables.insert(name.to_owned(), value.into());
        self
    }

    /// Adds an executable that prints this banner when asked for its version.
    #[must_use]
    pub fn tool(mut self, path: &str, banner: &str) -> Self {
        self.tools.insert(path.into(), banner.to_owned());
        self
    }

    /// Sets the answer to every run other than a request for the version.
    #[must_use]
    pub fn on_run<F>(mut self, handler: F) -> Self
    where
        F: Fn(&Invocation) -> Result<ProgramOutput, ToolError> + Send + Sync + 'static,
    {
        self.run_handler = Some(Box::new(handler));
        self
    }

    /// Returns the log of the commands, which grows as they run.
    #[must_use]
    pub fn log(&self) -> MockLog {
        self.log.clone()
    }
}

impl Host for MockHost {
    fn variable(&self, name: &str) -> Option<OsString> {
        self.variables.get(name).cloned()
    }

    fn is_executable(&self, path: &Path) -> bool {
        self.tools.contains_key(path)
    }

    fn run(&self, invocation: &Invocation) -> Result<ProgramOutput, ToolError> {
        let mut log = self.log.0.lock().unwrap_or_else(PoisonError::into_inner);
        log.push(invocation.command_line());
        drop(log);
        let asks_version =
            matches!(invocation.arguments().as_slice(), [flag] if is_version_flag(flag));
        match (self.tools.get(invocation.program()), &self.run_handler) {
            (Some(banner), _) if asks_version => Ok(ProgramOutput::success(banner.as_bytes())),
            (_, Some(handler)) => handler(invocation),
            _ => Ok(ProgramOutput::failure(127, "not scripted")),
        }
    }
}

fn is_version_flag(flag: &str) -> bool {
    Tool::ALL.iter().any(|tool| tool.version_flag() == flag)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_that_is_not_named_is_skipped() {
        assert_eq!(named_folder(None, true), None);
        assert_eq!(named_folder(Some(OsString::new()), true), None);
        assert_eq!(named_folder(Some("/nowhere".into()), false), None);
        let dir = tempfile::tempdir().unwrap();
        assert_eq!(named_folder(Some(dir.path().into()), true).unwrap(), dir.path());
    }

    #[test]
    #[should_panic(expected = "FOVEATE_DATA is `/nowhere`, which is not a folder")]
    fn data_that_is_named_and_missing_fails() {
        let _ = named_folder(Some("/nowhere".into()), true);
    }
}
