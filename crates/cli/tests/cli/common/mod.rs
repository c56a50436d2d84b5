// SPDX-License-Identifier: MIT OR Apache-2.0
//! Functions that run the command as a user does.

pub(crate) mod silicon;

use std::path::{Path, PathBuf};

use assert_cmd::Command;

/// Returns the command, with a cache that all tests share.
pub(crate) fn foveate(args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("foveate").unwrap();
    // The number of progress lines depends on the load of the machine.
    command.args(args).env("FOVEATE_PROGRESS", "0");
    command
}

/// Returns the command as a terminal starts it, for tests that send signals. Tests that run under
/// `nohup` or in the background of a script inherit ignored signals, and so would the command.
#[cfg(unix)]
pub(crate) fn foveate_with_signals() -> std::process::Command {
    if cfg!(target_os = "linux") {
        let mut command = std::process::Command::new("env");
        command.args(["--default-signal=INT,TERM,HUP", env!("CARGO_BIN_EXE_foveate")]);
        command
    } else {
        std::process::Command::new(env!("CARGO_BIN_EXE_foveate"))
    }
}

/// The output of a command, and its exit code.
pub(crate) struct CommandOutput {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Runs the command in `folder`.
pub(crate) fn run_in(folder: &Path, args: &[&str]) -> CommandOutput {
    let output = foveate(args).current_dir(folder).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    CommandOutput {
        code: output.status.code().unwrap(),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

/// Runs the command in `folder`, and fails unless its exit code is 0. Returns its standard output.
pub(crate) fn run_successfully(folder: &Path, args: &[&str]) -> String {
    let outcome = run_in(folder, args);
    assert_eq!(outcome.code, 0, "{args:?}: {}", outcome.stderr);
    outcome.stdout
}

/// Runs the command in `folder`, and expects the exit code `code` and one line on standard error,
/// besides warnings, that contains all of `parts`.
pub(crate) fn expect_failure(
    folder: &Path,
    code: i32,
    args: &[&str],
    parts: &[&str],
) -> CommandOutput {
    let outcome = run_in(folder, args);
    assert_eq!(outcome.code, code, "{args:?}: {}", outcome.stderr);
    let errors = outcome.stderr.lines().filter(|line| !line.starts_with("foveate: warning: "));
    assert_eq!(errors.count(), 1, "{args:?}: {}", outcome.stderr);
    for part in parts {
        assert!(outcome.stderr.contains(part), "{args:?}: {} lacks {part}", outcome.stderr);
    }
    outcome
}

/// Returns every file below `folder` with its path, sorted.
pub(crate) fn files_below(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_owned();
                found.push((name, std::fs::read(&path).unwrap()));
            }
        }
    }
    found.sort();
    found
}
