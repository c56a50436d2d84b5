// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs one child process. Input and output go through files, never through pipes: a child that
//! writes much before it reads cannot block, and a grandchild that lives on cannot hold us.

use std::fs::{self, File};
use std::io::{Read as _, Seek as _, Write as _};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::error::ToolError;
use crate::invocation::{Input, Invocation, Output};

/// Runs to the end, or to the time limit.
pub(crate) fn run(invocation: &Invocation) -> Result<Output, ToolError> {
    let program = &invocation.program;
    let mut stdout = match &invocation.stdout {
        Some(path) => File::create(path).map_err(ToolError::io("write", path))?,
        None => scratch()?,
    };
    let mut stderr = if invocation.merge { clone(&stdout)? } else { scratch()? };
    let mut command = Command::new(program);
    command
        .args(&invocation.args)
        .env("LC_ALL", "C")
        .envs(invocation.env.iter().map(|(name, value)| (name, value)))
        .stdin(stdin(&invocation.input)?)
        .stdout(clone(&stdout)?)
        .stderr(clone(&stderr)?);
    if let Some(dir) = &invocation.dir {
        command.current_dir(dir);
    }
    let mut child = command.spawn().map_err(ToolError::io("run", program))?;
    let status = wait(&mut child, invocation)?;
    Ok(Output {
        code: status.code(),
        status: status.to_string(),
        stdout: if invocation.stdout.is_some() { Vec::new() } else { contents(&mut stdout)? },
        stderr: if invocation.merge { Vec::new() } else { contents(&mut stderr)? },
    })
}

fn wait(child: &mut Child, invocation: &Invocation) -> Result<ExitStatus, ToolError> {
    let failed =
        |source| ToolError::Io { action: "wait for", path: invocation.program.clone(), source };
    let Some(limit) = invocation.timeout else { return child.wait().map_err(failed) };
    let start = Instant::now();
    let mut pause = Duration::from_micros(500);
    loop {
        if let Some(status) = child.try_wait().map_err(failed)? {
            return Ok(status);
        }
        if start.elapsed() >= limit {
            stop(child);
            return Err(ToolError::TimedOut { command: invocation.command_line(), limit });
        }
        sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(10));
    }
}

/// Ends the child and what it started: verilator, yosys and iverilog are drivers of other programs.
fn stop(child: &mut Child) {
    let below = descendants(child.id());
    // Each can only fail because the process has ended already.
    let _ = child.kill();
    if !below.is_empty() {
        let pids: Vec<String> = below.iter().map(u32::to_string).collect();
        let script = format!("kill -KILL {}", pids.join(" "));
        let _ = Command::new("sh").args(["-c", &script]).stderr(Stdio::null()).status();
    }
    let _ = child.wait();
}

/// All processes below `root`, as far as /proc tells.
fn descendants(root: u32) -> Vec<u32> {
    let mut found = vec![root];
    let mut next = 0;
    while let Some(&pid) = found.get(next) {
        let path = format!("/proc/{pid}/task/{pid}/children");
        let children = fs::read_to_string(path).unwrap_or_default();
        found.extend(children.split_whitespace().filter_map(|word| word.parse::<u32>().ok()));
        next += 1;
    }
    found.split_off(1)
}

fn stdin(input: &Input) -> Result<Stdio, ToolError> {
    match input {
        Input::Empty => Ok(Stdio::null()),
        Input::File(path) => File::open(path).map(Into::into).map_err(ToolError::io("read", path)),
        Input::Bytes(bytes) => {
            let mut file = scratch()?;
            file.write_all(bytes).and_then(|()| file.rewind()).map_err(temporary("write"))?;
            Ok(file.into())
        }
    }
}

fn contents(file: &mut File) -> Result<Vec<u8>, ToolError> {
    let mut bytes = Vec::new();
    file.rewind().and_then(|()| file.read_to_end(&mut bytes)).map_err(temporary("read"))?;
    Ok(bytes)
}

fn scratch() -> Result<File, ToolError> {
    tempfile::tempfile().map_err(temporary("create a file in"))
}

fn clone(file: &File) -> Result<File, ToolError> {
    file.try_clone().map_err(temporary("reuse a file in"))
}

fn temporary(action: &'static str) -> impl FnOnce(std::io::Error) -> ToolError {
    move |source| ToolError::io(action, Path::new(&std::env::temp_dir()))(source)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn sh(script: &str) -> Invocation {
        Invocation::new("sh").args(["-c", script])
    }

    #[test]
    fn much_output_before_any_input_is_read_does_not_block() {
        let input = vec![b'x'; 3 << 20];
        let script = "head -c 3000000 /dev/zero; cat";
        let output = run(&sh(script).stdin_bytes(input).timeout(Duration::from_secs(60))).unwrap();
        assert_eq!(output.stdout.len(), 3_000_000 + (3 << 20));
    }

    #[test]
    fn unread_input_is_no_error() {
        let output = run(&sh("exit 7").stdin_bytes(vec![0; 1 << 20])).unwrap();
        assert_eq!(output.code, Some(7));
    }

    #[test]
    fn streams_are_apart_or_merged_in_order() {
        let script = "echo a; echo b >&2; echo c";
        let apart = run(&sh(script)).unwrap();
        assert_eq!(
            (apart.stdout.as_slice(), apart.stderr.as_slice()),
            (&b"a\nc\n"[..], &b"b\n"[..])
        );
        let merged = run(&sh(script).merge_stderr()).unwrap();
        assert_eq!((merged.stdout.as_slice(), merged.stderr.len()), (&b"a\nb\nc\n"[..], 0));
    }

    #[test]
    fn time_limit_ends_the_whole_family() {
        let dir = tempfile::tempdir().unwrap();
        let script = "sh -c 'echo $$ > pid; sleep 60; true' & wait";
        let limit = Duration::from_millis(500);
        let error = run(&sh(script).dir(dir.path()).timeout(limit)).unwrap_err();
        assert!(matches!(error, ToolError::TimedOut { .. }), "{error}");
        let pid = fs::read_to_string(dir.path().join("pid")).unwrap();
        let stat = format!("/proc/{}/stat", pid.trim());
        let ended = || fs::read_to_string(&stat).map_or(true, |state| state.contains(") Z "));
        let patience = Instant::now() + Duration::from_secs(10);
        while !ended() {
            assert!(Instant::now() < patience, "the grandchild lives on");
            sleep(Duration::from_millis(10));
        }
    }

    #[test]
    fn files_and_folder_are_used() {
        let dir = tempfile::tempdir().unwrap();
        let (input, result) = (dir.path().join("in"), dir.path().join("out"));
        fs::write(&input, "text").unwrap();
        let output = run(&sh("cat; pwd").dir(dir.path()).stdin_file(&input).stdout_file(&result));
        assert!(output.unwrap().stdout.is_empty());
        assert!(fs::read_to_string(&result).unwrap().starts_with("text/"));
    }

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let error = run(&Invocation::new("/nonexistent/tool")).unwrap_err();
        assert!(error.to_string().starts_with("cannot run `/nonexistent/tool`"), "{error}");
    }
}
