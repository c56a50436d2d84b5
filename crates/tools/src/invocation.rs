// SPDX-License-Identifier: MIT OR Apache-2.0
//! One run of a program: its inputs and its outputs.

use std::ffi::{OsStr, OsString};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::error::ToolError;
use crate::escaping::shell_word;
use crate::source_files::log_excerpt;

/// The content of a program's standard input.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum StandardInput {
    /// The standard input is empty.
    #[default]
    Empty,
    /// The standard input has these bytes.
    Bytes(Vec<u8>),
    /// The standard input is the content of a file.
    File(PathBuf),
}

/// A program with all settings of its run. It runs when it is given to a [`Host`](crate::Host) or a
/// [`Toolchain`](crate::Toolchain).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Invocation {
    pub(crate) program: PathBuf,
    pub(crate) args: Vec<OsString>,
    pub(crate) env: Vec<(OsString, OsString)>,
    pub(crate) dir: Option<PathBuf>,
    pub(crate) input: StandardInput,
    pub(crate) stdout: Option<PathBuf>,
    pub(crate) merges_stderr: bool,
    pub(crate) timeout: Option<Duration>,
}

impl Invocation {
    /// Makes an invocation of a program in the current folder, without arguments, input or time
    /// limit.
    #[must_use]
    pub fn new(program: impl Into<PathBuf>) -> Self {
        Self {
            program: program.into(),
            args: Vec::new(),
            env: Vec::new(),
            dir: None,
            input: StandardInput::Empty,
            stdout: None,
            merges_stderr: false,
            timeout: None,
        }
    }

    /// Adds one argument.
    #[must_use]
    pub fn arg(mut self, arg: impl Into<OsString>) -> Self {
        self.args.push(arg.into());
        self
    }

    /// Adds several arguments.
    #[must_use]
    pub fn args<I>(mut self, args: I) -> Self
    where
        I: IntoIterator,
        I::Item: Into<OsString>,
    {
        self.args.extend(args.into_iter().map(Into::into));
        self
    }

    /// Sets an environment variable.
    #[must_use]
    pub fn env(mut self, name: impl Into<OsString>, value: impl Into<OsString>) -> Self {
        self.env.push((name.into(), value.into()));
        self
    }

    /// Sets the folder in which the program runs.
    #[must_use]
    pub fn dir(mut self, dir: impl Into<PathBuf>) -> Self {
        self.dir = Some(dir.into());
        self
    }

    /// Feeds bytes to the standard input.
    #[must_use]
    pub fn stdin_bytes(mut self, bytes: impl Into<Vec<u8>>) -> Self {
        self.input = StandardInput::Bytes(bytes.into());
        self
    }

    /// Feeds a file to the standard input.
    #[must_use]
    pub fn stdin_file(mut self, path: impl Into<PathBuf>) -> Self {
        self.input = StandardInput::File(path.into());
        self
    }

    /// Sends the standard output to a file; [`ProgramOutput::stdout`] is then empty.
    #[must_use]
    pub fn stdout_file(mut self, path: impl Into<PathBuf>) -> Self {
        self.stdout = Some(path.into());
        self
    }

    /// Writes the standard error into the standard output, in the order in which the program
    /// writes.
    #[must_use]
    pub fn merge_stderr(mut self) -> Self {
        self.merges_stderr = true;
        self
    }

    /// Sets a time limit, after which the program and all processes that it started are stopped.
    #[must_use]
    pub fn timeout(mut self, limit: Duration) -> Self {
        self.timeout = Some(limit);
        self
    }

    /// Returns the program.
    #[must_use]
    pub fn program(&self) -> &Path {
        &self.program
    }

    /// Returns the arguments, on which mocks base their answer.
    #[must_use]
    pub fn arguments(&self) -> Vec<String> {
        self.args.iter().map(|arg| arg.to_string_lossy().into_owned()).collect()
    }

    /// Returns the folder in which the program will run, if one was set.
    #[must_use]
    pub fn directory(&self) -> Option<&Path> {
        self.dir.as_deref()
    }

    /// Returns the content of the standard input.
    #[must_use]
    pub fn input(&self) -> &StandardInput {
        &self.input
    }

    /// Returns the command line in the syntax of a shell.
    #[must_use]
    pub fn command_line(&self) -> String {
        let mut line = quoted(self.program.as_os_str());
        for arg in &self.args {
            // Writing to a string cannot fail.
            let _ = write!(line, " {}", quoted(arg));
        }
        line
    }
}

/// The result of a finished program.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ProgramOutput {
    /// The exit code; `None` if a signal ended the program.
    pub code: Option<i32>,
    /// The exit code or signal as words.
    pub status: String,
    /// The standard output, unless it went to a file.
    pub stdout: Vec<u8>,
    /// The standard error, unless it was merged into the standard output.
    pub stderr: Vec<u8>,
}

impl ProgramOutput {
    /// Makes a success with this standard output, for mocks.
    #[must_use]
    pub fn success(stdout: impl Into<Vec<u8>>) -> Self {
        Self {
            code: Some(0),
            status: "exit status: 0".into(),
            stdout: stdout.into(),
            stderr: vec![],
        }
    }

    /// Makes a failure with this exit code and standard error, for mocks.
    #[must_use]
    pub fn failure(code: i32, stderr: impl Into<Vec<u8>>) -> Self {
        let status = format!("exit status: {code}");
        Self { code: Some(code), status, stdout: vec![], stderr: stderr.into() }
    }

    /// Returns whether the exit code is zero.
    #[must_use]
    pub fn is_success(&self) -> bool {
        self.code == Some(0)
    }

    /// Returns the standard output and the standard error as text.
    #[must_use]
    pub fn log(&self) -> String {
        let mut log = String::from_utf8_lossy(&self.stdout).into_owned();
        log.push_str(&String::from_utf8_lossy(&self.stderr));
        log
    }

    /// Turns an exit code other than zero into an error with the end of the log.
    ///
    /// # Errors
    /// Fails with [`ToolError::Failed`], which names the command of `invocation`.
    pub fn into_checked(self, invocation: &Invocation) -> Result<Self, ToolError> {
        if self.is_success() {
            return Ok(self);
        }
        let full = self.log();
        let silent = full.trim().is_empty();
        Err(ToolError::Failed {
            command: invocation.command_line(),
            status: self.status,
            tail: if silent { silent_failure_advice(invocation) } else { log_excerpt(&full) },
            full,
            log: None,
        })
    }
}

/// Returns advice for a program that failed without a message. A full disk is a likely cause,
/// because messages are written to a disk, too.
fn silent_failure_advice(invocation: &Invocation) -> String {
    let temporary = std::env::temp_dir();
    let places = invocation.dir.iter().chain([&temporary]);
    let places: Vec<_> = places.map(|place| format!("`{}`", place.display())).collect();
    format!(
        "it printed nothing, as happens on a full disk; check the free space in {}",
        places.join(" and in ")
    )
}

fn quoted(word: &OsStr) -> String {
    shell_word(&word.to_string_lossy()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn command_lines_can_be_pasted() {
        let invocation = Invocation::new("yosys").args(["-p", "read it's"]).arg("");
        assert_eq!(invocation.command_line(), r"yosys -p 'read it'\''s' ''");
    }

    #[test]
    fn failures_carry_command_code_and_log() {
        let error =
            ProgramOutput::failure(3, "bad\n").into_checked(&Invocation::new("tool")).unwrap_err();
        assert_eq!(error.to_string(), "`tool` failed (exit status: 3):\nbad");
    }

    #[test]
    fn a_failure_without_a_word_points_to_the_disk() {
        let tool = Invocation::new("tool").dir("/build");
        let error = ProgramOutput::failure(1, "\n").into_checked(&tool).unwrap_err().to_string();
        assert!(error.contains("printed nothing, as happens on a full disk"), "{error}");
        for place in [Path::new("/build"), &std::env::temp_dir()] {
            assert!(error.contains(&format!("`{}`", place.display())), "{error}");
        }
    }
}
