// SPDX-License-Identifier: MIT OR Apache-2.0
//! Helpers for tests: skip where a tool or data is missing, and a machine without any tool.

use std::collections::HashMap;
use std::ffi::OsString;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::error::ToolError;
use crate::host::Host;
use crate::invocation::{Invocation, Output};
use crate::tool::Tool;
use crate::toolchain::Toolchain;

/// Whether a test that needs these tools can run. If not, says so on the terminal, past the capture
/// of the test harness.
///
/// # Panics
/// When a tool cannot be used and the environment variable `FOVEATE_REQUIRE_TOOLS` is `1`, so that a
/// test server does not skip in silence.
#[must_use]
pub fn require_tools(tools: &[Tool]) -> bool {
    let toolchain = Toolchain::system();
    let Some(error) = tools.iter().find_map(|&tool| toolchain.find(tool).err()) else {
        return true;
    };
    assert!(!is_strict(), "FOVEATE_REQUIRE_TOOLS is 1, but {error}");
    skip(&error.to_string());
    false
}

/// Whether tests take lists whole that take long, and not a part of them: with the environment variable `FOVEATE_WHOLE` set, as
/// `scripts/release.sh` sets it.
#[must_use]
pub fn takes_whole_lists() -> bool {
    std::env::var_os("FOVEATE_WHOLE").is_some()
}

/// The step through a list of which each `n`-th item is enough for every run.
#[must_use]
pub fn every(n: usize) -> usize {
    if takes_whole_lists() { 1 } else { n }
}

/// The folder of real images and video that the environment variable `FOVEATE_DATA` names. Without
/// one, says on the terminal that the test is skipped.
///
/// # Panics
/// When the variable names something else than a folder and `FOVEATE_REQUIRE_TOOLS` is `1`. What is missing
/// in the folder is for the test to fail on.
#[must_use]
pub fn data_folder() -> Option<PathBuf> {
    named_folder(std::env::var_os("FOVEATE_DATA"), is_strict())
}

fn named_folder(named: Option<OsString>, strict: bool) -> Option<PathBuf> {
    let Some(path) = named.filter(|name| !name.is_empty()).map(PathBuf::from) else {
        skip("FOVEATE_DATA is not set");
        return None;
    };
    if path.is_dir() {
        return Some(path);
    }
    let problem = format!("FOVEATE_DATA is `{}`, which is no folder", path.display());
    assert!(!strict, "FOVEATE_REQUIRE_TOOLS is 1, but {problem}");
    skip(&problem);
    None
}

/// Whether tests that lack something fail instead of being skipped.
fn is_strict() -> bool {
    std::env::var_os("FOVEATE_REQUIRE_TOOLS").is_some_and(|value| value == "1")
}

/// Says that a test is skipped, and why, past the capture of the test harness.
pub fn skip(reason: &str) {
    let name = std::thread::current().name().unwrap_or("test").to_owned();
    // One write, so that tests side by side do not mix; nothing can be done for a lost terminal.
    let line = format!("\nSKIPPED {name}: {reason}\n");
    let _ = std::io::stderr().write_all(line.as_bytes());
}

type Handler = Box<dyn Fn(&Invocation) -> Result<Output, ToolError> + Send + Sync>;

/// A machine with scripted tools, whose `PATH` is `/opt/bin`.
#[derive(Default)]
pub struct MockHost {
    variables: HashMap<String, OsString>,
    tools: HashMap<PathBuf, String>,
    handler: Option<Handler>,
    log: MockLog,
}

/// The commands that a [`MockHost`] ran.
#[derive(Debug, Clone, Default)]
pub struct MockLog(Arc<Mutex<Vec<String>>>);

impl MockLog {
    /// The command lines in order.
    #[must_use]
    pub fn commands(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl MockHost {
    /// A machine without any tool.
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

    /// Adds an executable that prints this when asked for its version.
    #[must_use]
    pub fn tool(mut self, path: &str, banner: &str) -> Self {
        self.tools.insert(path.into(), banner.to_owned());
        self
    }

    /// Answers every run other than a question for the version.
    #[must_use]
    pub fn on_run<F>(mut self, handler: F) -> Self
    where
        F: Fn(&Invocation) -> Result<Output, ToolError> + Send + Sync + 'static,
    {
        self.handler = Some(Box::new(handler));
        self
    }

    /// What will have been run.
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

    fn run(&self, invocation: &Invocation) -> Result<Output, ToolError> {
        let mut log = self.log.0.lock().unwrap_or_else(PoisonError::into_inner);
        log.push(invocation.command_line());
        drop(log);
        let asks_version =
            matches!(invocation.arguments().as_slice(), [flag] if is_version_flag(flag));
        match (self.tools.get(invocation.program()), &self.handler) {
            (Some(banner), _) if asks_version => Ok(Output::success(banner.as_bytes())),
            (_, Some(handler)) => handler(invocation),
            _ => Ok(Output::failure(127, "not scripted")),
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
    #[should_panic(expected = "FOVEATE_DATA is `/nowhere`, which is no folder")]
    fn data_that_is_named_and_missing_fails() {
        let _ = named_folder(Some("/nowhere".into()), true);
    }
}
