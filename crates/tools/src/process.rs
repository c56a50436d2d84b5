// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs one child process ([`run`]), and ends it with all processes that it has started:
//! verilator, yosys and iverilog run other programs. Input and output go through files, never
//! through pipes, so a child that writes much before it reads cannot block, and a grandchild
//! that outlives the child cannot delay this process.
//!
//! A child and its descendants are a process group of their own ([`ProcessFamily`]). An
//! interrupt from the terminal therefore reaches only this program, which decides how to end. A
//! signal that ends the group ends every member. Families that have not ended are registered,
//! so that a process that exits at once leaves none of them running
//! ([`end_all_process_families`]).

use crate::error::ToolError;
use crate::interrupt::flag_is_set_soon;
use crate::invocation::{Invocation, ProgramOutput, StandardInput};
use std::collections::BTreeSet;
use std::fs::File;
use std::io;
use std::io::{Read as _, Seek as _, Write as _};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Runs a program to its end, to its time limit, or until `cancel` is set.
pub(crate) fn run(
    invocation: &Invocation,
    cancel: &AtomicBool,
) -> Result<ProgramOutput, ToolError> {
    let program = &invocation.program;
    let mut stdout = match &invocation.stdout {
        Some(path) => File::create(path).map_err(ToolError::io("write", path))?,
        None => temporary_file()?,
    };
    let mut stderr = if invocation.merges_stderr { duplicate(&stdout)? } else { temporary_file()? };
    let mut command = Command::new(program);
    command
        .args(&invocation.args)
        .env("LC_ALL", "C")
        .envs(invocation.env.iter().map(|(name, value)| (name, value)))
        .stdin(stdin(&invocation.input)?)
        .stdout(duplicate(&stdout)?)
        .stderr(duplicate(&stderr)?);
    if let Some(dir) = &invocation.dir {
        command.current_dir(dir);
    }
    let mut family = ProcessFamily::start(&mut command).map_err(ToolError::io("run", program))?;
    let status = wait(&mut family, invocation, cancel)?;
    Ok(ProgramOutput {
        code: status.code(),
        status: status.to_string(),
        stdout: if invocation.stdout.is_some() { Vec::new() } else { read_all(&mut stdout)? },
        stderr: if invocation.merges_stderr { Vec::new() } else { read_all(&mut stderr)? },
    })
}

fn wait(
    family: &mut ProcessFamily,
    invocation: &Invocation,
    cancel: &AtomicBool,
) -> Result<ExitStatus, ToolError> {
    let failed =
        |source| ToolError::Io { action: "wait for", path: invocation.program.clone(), source };
    let start = Instant::now();
    loop {
        if let Some(status) = family.try_wait().map_err(failed)? {
            let stopped =
                !status.success() && (was_signalled_to_stop(status) || flag_is_set_soon(cancel));
            return if stopped { Err(ToolError::Interrupted) } else { Ok(status) };
        }
        if cancel.load(Ordering::Relaxed) {
            family.end();
            return Err(ToolError::Interrupted);
        }
        if let Some(limit) = invocation.timeout.filter(|&limit| start.elapsed() >= limit) {
            family.end();
            return Err(ToolError::TimedOut { command: invocation.command_line(), limit });
        }
        // The pauses grow with the elapsed time, so a short run is hardly delayed.
        sleep((start.elapsed() / 16).clamp(Duration::from_micros(500), Duration::from_millis(10)));
    }
}

#[cfg(unix)]
fn was_signalled_to_stop(status: ExitStatus) -> bool {
    use rustix::process::Signal;
    use std::os::unix::process::ExitStatusExt as _;
    let stop_signals = [Signal::INT, Signal::TERM, Signal::HUP].map(Signal::as_raw);
    status.signal().is_some_and(|signal| stop_signals.contains(&signal))
}

#[cfg(not(unix))]
fn was_signalled_to_stop(_: ExitStatus) -> bool {
    false
}

fn stdin(input: &StandardInput) -> Result<Stdio, ToolError> {
    match input {
        StandardInput::Empty => Ok(Stdio::null()),
        StandardInput::File(path) => {
            File::open(path).map(Into::into).map_err(ToolError::io("read", path))
        }
        StandardInput::Bytes(bytes) => {
            let mut file = temporary_file()?;
            file.write_all(bytes).and_then(|()| file.rewind()).map_err(temporary_error("write"))?;
            Ok(file.into())
        }
    }
}

fn read_all(file: &mut File) -> Result<Vec<u8>, ToolError> {
    let mut bytes = Vec::new();
    file.rewind().and_then(|()| file.read_to_end(&mut bytes)).map_err(temporary_error("read"))?;
    Ok(bytes)
}

fn temporary_file() -> Result<File, ToolError> {
    tempfile::tempfile().map_err(temporary_error("create a file in"))
}

fn duplicate(file: &File) -> Result<File, ToolError> {
    file.try_clone().map_err(temporary_error("reuse a file in"))
}

fn temporary_error(action: &'static str) -> impl FnOnce(io::Error) -> ToolError {
    move |source| ToolError::temporary(action, &std::env::temp_dir())(source)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn run(invocation: &Invocation) -> Result<ProgramOutput, ToolError> {
        super::run(invocation, &AtomicBool::new(false))
    }

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

    /// A shell script with a grandchild that holds the pipe `alive` of its folder open as long as
    /// it lives.
    const FAMILY: &str = "sh -c 'sleep 60; true' > alive & wait";

    /// Makes a folder with the pipe of [`FAMILY`]. The returned receiver gets a message once no
    /// process holds the pipe open.
    #[allow(clippy::unwrap_used, reason = "helper of tests")]
    fn pipe() -> (tempfile::TempDir, std::sync::mpsc::Receiver<()>) {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("alive");
        assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
        let (sender, ended) = std::sync::mpsc::channel();
        std::thread::spawn(move || {
            let read = File::open(path).and_then(|mut pipe| pipe.read_to_end(&mut Vec::new()));
            read.map(|_| sender.send(()))
        });
        (dir, ended)
    }

    fn assert_ended(ended: &std::sync::mpsc::Receiver<()>) {
        let ended = ended.recv_timeout(Duration::from_secs(20));
        assert!(ended.is_ok(), "the grandchild lives on");
    }

    #[test]
    fn time_limit_ends_the_whole_family() {
        let (dir, ended) = pipe();
        let limit = Duration::from_millis(500);
        let error = run(&sh(FAMILY).dir(dir.path()).timeout(limit)).unwrap_err();
        assert!(matches!(error, ToolError::TimedOut { .. }), "{error}");
        assert_ended(&ended);
    }

    #[test]
    fn an_interrupt_ends_the_whole_family() {
        let (dir, ended) = pipe();
        let script = sh(FAMILY).dir(dir.path());
        let cancel = AtomicBool::new(false);
        let start = Instant::now();
        std::thread::scope(|scope| {
            let running = scope.spawn(|| super::run(&script, &cancel));
            sleep(Duration::from_millis(500));
            assert!(ended.try_recv().is_err(), "the grandchild lives until it is stopped");
            cancel.store(true, Ordering::Relaxed);
            assert!(running.join().unwrap().unwrap_err().is_interrupted());
        });
        assert!(start.elapsed() < Duration::from_secs(30));
        assert_ended(&ended);
    }

    /// Returns whether this process was started to ignore a signal, as with `nohup` and `&` in a
    /// script. Its children then ignore the signal, too.
    fn is_ignored(signal: rustix::process::Signal) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let ignored = line.map_or(0, |line| u64::from_str_radix(line.trim(), 16).expect("a mask"));
        ignored >> (signal.as_raw() - 1) & 1 == 1
    }

    #[test]
    fn a_child_that_ends_on_a_stop_signal_counts_as_interrupted() {
        use rustix::process::Signal;
        let signals = [("INT", Signal::INT), ("TERM", Signal::TERM), ("HUP", Signal::HUP)];
        for (signal, _) in signals.into_iter().filter(|&(_, signal)| !is_ignored(signal)) {
            let error = run(&sh(&format!("kill -{signal} $$"))).unwrap_err();
            assert!(error.is_interrupted(), "{signal}: {error}");
        }
        assert_eq!(run(&sh("kill -KILL $$")).unwrap().code, None);
    }

    #[test]
    fn files_and_folder_are_used() {
        let dir = tempfile::tempdir().unwrap();
        let (input, result) = (dir.path().join("in"), dir.path().join("out"));
        std::fs::write(&input, "text").unwrap();
        let output = run(&sh("cat; pwd").dir(dir.path()).stdin_file(&input).stdout_file(&result));
        assert!(output.unwrap().stdout.is_empty());
        assert!(std::fs::read_to_string(&result).unwrap().starts_with("text/"));
    }

    #[test]
    fn the_error_names_a_missing_program() {
        let error = run(&Invocation::new("/nonexistent/tool")).unwrap_err();
        assert!(error.to_string().starts_with("cannot run `/nonexistent/tool`"), "{error}");
    }
}

/// The registered families: the first processes of families that have not been waited for, by
/// process number.
struct ProcessFamilyRegistry {
    leaders: BTreeSet<u32>,
    /// True if this process is about to exit, so that no new family may start.
    is_closed: bool,
}

static REGISTRY: Mutex<ProcessFamilyRegistry> =
    Mutex::new(ProcessFamilyRegistry { leaders: BTreeSet::new(), is_closed: false });

fn locked_registry() -> MutexGuard<'static, ProcessFamilyRegistry> {
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends every family of this process and refuses new ones. A process that exits at once calls this.
pub fn end_all_process_families() {
    let mut registry = locked_registry();
    registry.is_closed = true;
    registry.leaders.iter().copied().for_each(kill);
}

/// A running child that is the first process of a family. Dropping this value ends the family.
#[derive(Debug)]
pub(crate) struct ProcessFamily {
    pub(crate) leader: Child,
}

impl ProcessFamily {
    /// Starts a program as the first process of a family.
    pub(crate) fn start(command: &mut Command) -> io::Result<Self> {
        set_process_group(command);
        let mut registry = locked_registry();
        if registry.is_closed {
            return Err(io::Error::other("the program is about to end"));
        }
        let leader = command.spawn()?;
        registry.leaders.insert(leader.id());
        Ok(Self { leader })
    }

    /// Returns the status of the first process if it has ended.
    pub(crate) fn try_wait(&mut self) -> io::Result<Option<ExitStatus>> {
        // Once a process has been waited for, the system may reuse its number, so the registry
        // stays locked until the number is removed from it.
        let mut registry = locked_registry();
        let ended = self.leader.try_wait()?;
        if ended.is_some() {
            registry.leaders.remove(&self.leader.id());
        }
        Ok(ended)
    }

    /// Ends the whole family if its first process has not ended by itself, and waits for that
    /// process.
    pub(crate) fn end(&mut self) {
        if matches!(self.try_wait(), Ok(None)) {
            self.kill();
            let _ = self.leader.wait();
            locked_registry().leaders.remove(&self.leader.id());
        }
    }

    #[cfg(unix)]
    fn kill(&mut self) {
        kill(self.leader.id());
    }

    /// Ends only the first process, because other systems have no process groups.
    #[cfg(not(unix))]
    fn kill(&mut self) {
        // An error can only mean that the process has already ended.
        let _ = self.leader.kill();
    }
}

impl Drop for ProcessFamily {
    fn drop(&mut self) {
        self.end();
    }
}

#[cfg(unix)]
fn set_process_group(command: &mut Command) {
    use std::os::unix::process::CommandExt as _;
    command.process_group(0);
}

/// Ends a process group by the number of its first process.
#[cfg(unix)]
fn kill(leader: u32) {
    use rustix::process::{Pid, Signal, kill_process_group};
    if let Some(group) = i32::try_from(leader).ok().and_then(Pid::from_raw) {
        // An error can only mean that all processes have already ended.
        let _ = kill_process_group(group, Signal::KILL);
    }
}

#[cfg(not(unix))]
fn set_process_group(_: &mut Command) {}

/// Does nothing, because other systems cannot end a process by its number alone.
#[cfg(not(unix))]
fn kill(_: u32) {}
