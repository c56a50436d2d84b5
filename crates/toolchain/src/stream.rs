// SPDX-License-Identifier: MIT OR Apache-2.0
//! A program whose output is read while it runs: what it writes goes through a pipe, as much as the
//! reader takes, and what it says is collected line by line beside it.
//!
//! It cannot block: a thread always empties the standard error, and the standard output may fill up
//! only while nobody reads it. It does not outlive its [`Stream`], and Ctrl-C in the terminal does not
//! reach it, so that its reader decides how to end.

use std::io::{self, BufRead, BufReader, Read};
use std::process::{Child, ChildStderr, ChildStdout, Command, Stdio};
use std::sync::mpsc::{self, Receiver, Sender};

use crate::error::ToolError;
use crate::invocation::Invocation;

/// Longest line that is kept whole.
const LINE: u64 = 1 << 14;

/// A running program.
#[derive(Debug)]
pub struct Stream {
    child: Child,
    stdout: ChildStdout,
    lines: Receiver<String>,
}

impl Stream {
    /// Starts a program with nothing on its standard input; a time limit does not apply.
    ///
    /// # Errors
    /// When it cannot be started.
    pub fn start(invocation: &Invocation) -> Result<Self, ToolError> {
        let mut command = Command::new(&invocation.program);
        command
            .args(&invocation.args)
            .env("LC_ALL", "C")
            .envs(invocation.env.iter().map(|(name, value)| (name, value)))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        if let Some(dir) = &invocation.dir {
            command.current_dir(dir);
        }
        apart(&mut command);
        let mut child = command.spawn().map_err(ToolError::io("run", &invocation.program))?;
        let pipes = (child.stdout.take(), child.stderr.take());
        let (Some(stdout), Some(stderr)) = pipes else {
            let lost = io::Error::other("its pipes are missing");
            return Err(ToolError::io("run", &invocation.program)(lost));
        };
        let (sender, lines) = mpsc::channel();
        let collector = std::thread::Builder::new().name("stderr of a tool".to_owned());
        if let Err(error) = collector.spawn(move || collect(stderr, &sender)) {
            end(&mut child);
            return Err(ToolError::io("run", &invocation.program)(error));
        }
        Ok(Self { child, stdout, lines })
    }

    /// The next line of the standard error; waits for it. `None` when there will be no more.
    pub fn next_line(&self) -> Option<String> {
        self.lines.recv().ok()
    }

    /// Waits for the end, after the output has been read: whether the exit code was zero, and the
    /// exit code or signal in words.
    ///
    /// # Errors
    /// When the system does not tell.
    pub fn finish(&mut self) -> io::Result<(bool, String)> {
        self.child.wait().map(|status| (status.success(), status.to_string()))
    }
}

impl Read for Stream {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stdout.read(bytes)
    }
}

impl Drop for Stream {
    fn drop(&mut self) {
        end(&mut self.child);
    }
}

fn end(child: &mut Child) {
    // Each can only fail because the process has ended already.
    let _ = child.kill();
    let _ = child.wait();
}

fn collect(stderr: ChildStderr, lines: &Sender<String>) {
    let mut reader = BufReader::new(stderr);
    let mut line = Vec::new();
    while matches!(reader.by_ref().take(LINE).read_until(b'\n', &mut line), Ok(1..)) {
        // When nobody listens any more, the pipe is still emptied.
        let _ = lines.send(String::from_utf8_lossy(&line).trim_end().to_owned());
        line.clear();
    }
}

/// Puts a program that is to be started into a process group of its own: an interrupt from the
/// terminal goes to whoever reads or feeds it alone, which decides how to end.
#[cfg(unix)]
pub fn apart(command: &mut Command) {
    use std::os::unix::process::CommandExt as _;
    command.process_group(0);
}

/// Elsewhere there are no process groups.
#[cfg(not(unix))]
pub fn apart(_: &mut Command) {}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str) -> Invocation {
        Invocation::new("sh").args(["-c", script])
    }

    #[test]
    fn output_and_lines_are_apart_and_neither_blocks_the_other() {
        let script = "head -c 1000000 /dev/zero | tr '\\0' x >&2; echo >&2; \
                      head -c 3000000 /dev/zero; echo last >&2; exit 3";
        let mut stream = Stream::start(&shell(script)).unwrap();
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).unwrap();
        assert_eq!(bytes.len(), 3_000_000);
        let lines: Vec<String> = std::iter::from_fn(|| stream.next_line()).collect();
        assert_eq!(lines.last().map(String::as_str), Some("last"));
        assert!(lines.iter().all(|line| line.len() <= 1 << 14));
        assert_eq!(stream.finish().unwrap(), (false, "exit status: 3".to_owned()));
    }

    #[test]
    fn a_stream_that_is_dropped_ends_its_program() {
        let stream = Stream::start(&shell("echo $$ >&2; exec sleep 60")).unwrap();
        let pid = stream.next_line().unwrap();
        drop(stream);
        assert!(!std::path::Path::new(&format!("/proc/{pid}")).exists());
    }

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let error = Stream::start(&Invocation::new("/nonexistent/tool")).unwrap_err();
        assert!(error.to_string().starts_with("cannot run `/nonexistent/tool`"), "{error}");
    }
}
