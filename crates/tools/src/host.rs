// SPDX-License-Identifier: MIT OR Apache-2.0
//! The machine that the toolchain runs on, as a trait, so that tests need no tools.

use std::ffi::OsString;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::ToolError;
use crate::invocation::{Invocation, ProgramOutput};
use crate::process;

/// The environment, the files and the processes of a machine.
pub trait Host: Send + Sync {
    /// Returns the value of an environment variable.
    fn variable(&self, name: &str) -> Option<OsString>;

    /// Returns whether the path is an executable file.
    fn is_executable(&self, path: &Path) -> bool;

    /// Runs a program to its end, whatever its exit code.
    ///
    /// # Errors
    /// Fails if the program cannot be started, its files cannot be used, or the time limit is
    /// reached.
    fn run(&self, invocation: &Invocation) -> Result<ProgramOutput, ToolError>;

    /// Runs a program like [`Host::run`], but stops it when `cancel` is set. A host that cannot
    /// stop a program checks the flag before the start.
    ///
    /// # Errors
    /// Fails like [`Host::run`], and with [`ToolError::Interrupted`].
    fn run_until(
        &self,
        invocation: &Invocation,
        cancel: &AtomicBool,
    ) -> Result<ProgramOutput, ToolError> {
        if cancel.load(Ordering::Relaxed) {
            return Err(ToolError::Interrupted);
        }
        self.run(invocation)
    }
}

/// The machine that this program runs on.
#[derive(Debug, Clone, Copy, Default)]
pub struct SystemHost;

impl Host for SystemHost {
    fn variable(&self, name: &str) -> Option<OsString> {
        std::env::var_os(name)
    }

    fn is_executable(&self, path: &Path) -> bool {
        std::fs::metadata(path).is_ok_and(|meta| meta.is_file() && may_run(&meta))
    }

    fn run(&self, invocation: &Invocation) -> Result<ProgramOutput, ToolError> {
        process::run(invocation, &AtomicBool::new(false))
    }

    fn run_until(
        &self,
        invocation: &Invocation,
        cancel: &AtomicBool,
    ) -> Result<ProgramOutput, ToolError> {
        process::run(invocation, cancel)
    }
}

#[cfg(unix)]
fn may_run(meta: &std::fs::Metadata) -> bool {
    use std::os::unix::fs::PermissionsExt as _;
    meta.permissions().mode() & 0o111 != 0
}

#[cfg(not(unix))]
fn may_run(_: &std::fs::Metadata) -> bool {
    true
}
