// SPDX-License-Identifier: MIT OR Apache-2.0
//! A program whose output is read, or whose input is written, while it runs: as much goes through a
//! pipe as the other side takes, and what it says is collected line by line beside it.
//!
//! It cannot block: a thread always empties the standard error, and a pipe may fill up only while
//! nobody reads it. It does not outlive its [`Stream`] or [`Feeder`], and Ctrl-C in the terminal does
//! not reach it, so that its other side decides how to end.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{self, Receiver, Sender};

use crate::error::ToolError;
use crate::family;
use crate::invocation::Invocation;

/// Longest line that is kept whole.
const LINE: u64 = 1 << 14;

/// A running program and what it says.
#[derive(Debug)]
struct Running {
    child: Child,
    lines: Receiver<String>,
}

/// A running program whose standard output is read.
#[derive(Debug)]
pub struct Stream {
    running: Running,
    stdout: ChildStdout,
}

/// A running program whose standard input is written.
#[derive(Debug)]
pub struct Feeder {
    running: Running,
    /// None once the input has ended.
    stdin: Option<ChildStdin>,
}

impl Stream {
    /// Starts a program with nothing on its standard input; a time limit does not apply.
    ///
    /// # Errors
    /// When it cannot be started.
    pub fn start(invocation: &Invocation) -> Result<Self, ToolError> {
        let mut running = Running::start(invocation, Stdio::null(), Stdio::piped())?;
        let stdout = running.child.stdout.take().ok_or_else(|| lost_pipe(invocation))?;
        widen(&stdout);
        Ok(Self { running, stdout })
    }

    /// The next line of the standard error; waits for it. `None` when there will be no more.
    pub fn next_line(&self) -> Option<String> {
        self.running.lines.recv().ok()
    }

    /// Waits for the end, after the output has been read: whether the exit code was zero, and the
    /// exit code or signal in words.
    ///
    /// # Errors
    /// When the system does not tell.
    pub fn finish(&mut self) -> io::Result<(bool, String)> {
        self.running.wait()
    }

    /// Ends the program, whatever it was about to write.
    pub fn stop(&mut self) {
        family::end(&mut self.running.child);
    }
}

impl Read for Stream {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stdout.read(bytes)
    }
}

impl Feeder {
    /// Starts a program whose standard output goes nowhere; a time limit does not apply.
    ///
    /// # Errors
    /// When it cannot be started.
    pub fn start(invocation: &Invocation) -> Result<Self, ToolError> {
        let mut running = Running::start(invocation, Stdio::piped(), Stdio::null())?;
        let stdin = running.child.stdin.take().ok_or_else(|| lost_pipe(invocation))?;
        widen(&stdin);
        Ok(Self { running, stdin: Some(stdin) })
    }

    /// Ends the input and waits for the end of the program: whether the exit code was zero, and the
    /// last line that it said, if it said anything.
    ///
    /// # Errors
    /// When the system does not tell.
    pub fn finish(&mut self) -> io::Result<(bool, Option<String>)> {
        drop(self.stdin.take());
        let (success, _) = self.running.wait()?;
        let said = self.running.lines.iter().filter(|line| !line.trim().is_empty());
        Ok((success, said.last()))
    }
}

impl Write for Feeder {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stdin.as_mut().ok_or(io::ErrorKind::BrokenPipe)?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Running {
    fn start(invocation: &Invocation, stdin: Stdio, stdout: Stdio) -> Result<Self, ToolError> {
        let mut command = Command::new(&invocation.program);
        command
            .args(&invocation.args)
            .env("LC_ALL", "C")
            .envs(invocation.env.iter().map(|(name, value)| (name, value)))
            .stdin(stdin)
            .stdout(stdout)
            .stderr(Stdio::piped());
        if let Some(dir) = &invocation.dir {
            command.current_dir(dir);
        }
        family::found(&mut command);
        let child = command.spawn().map_err(ToolError::io("run", &invocation.program))?;
        let (sender, lines) = mpsc::channel();
        // From here on the child ends with what holds it.
        let mut running = Self { child, lines };
        let stderr = running.child.stderr.take().ok_or_else(|| lost_pipe(invocation))?;
        let collector = std::thread::Builder::new().name("stderr of a tool".to_owned());
        let collector = collector.spawn(move || collect(stderr, &sender));
        collector.map_err(ToolError::io("run", &invocation.program))?;
        Ok(running)
    }

    fn wait(&mut self) -> io::Result<(bool, String)> {
        self.child.wait().map(|status| (status.success(), status.to_string()))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        family::end(&mut self.child);
    }
}

fn lost_pipe(invocation: &Invocation) -> ToolError {
    ToolError::io("run", &invocation.program)(io::Error::other("its pipes are missing"))
}

/// Makes a pipe hold about a frame of video, so that its two sides wake each other less often.
#[cfg(target_os = "linux")]
fn widen(pipe: &impl std::os::fd::AsFd) {
    /// What the system allows everyone by default.
    const BYTES: usize = 1 << 20;
    // Where it is refused the pipe works as it is.
    let _ = rustix::pipe::fcntl_setpipe_size(pipe, BYTES);
}

/// Elsewhere a pipe has the size that it has.
#[cfg(not(target_os = "linux"))]
fn widen<T>(_: &T) {}

fn collect(stderr: ChildStderr, lines: &Sender<String>) {
    let mut reader = BufReader::new(stderr);
    let mut line = Vec::new();
    while matches!(reader.by_ref().take(LINE).read_until(b'\n', &mut line), Ok(1..)) {
        // When nobody listens any more, the pipe is still emptied.
        let _ = lines.send(String::from_utf8_lossy(&line).trim_end().to_owned());
        line.clear();
    }
}

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
        let alive = Command::new("kill").args(["-0", &pid]).stderr(Stdio::null()).status();
        assert!(!alive.unwrap().success());
    }

    #[test]
    fn a_program_that_is_fed_ends_with_its_input_and_its_last_words_are_kept() {
        let dir = tempfile::tempdir().unwrap();
        let copy = dir.path().join("copy");
        let script = format!("cat > '{}'; echo first >&2; echo last >&2; exit 3", copy.display());
        let mut feeder = Feeder::start(&shell(&script)).unwrap();
        feeder.write_all(&[7; 3_000_000]).unwrap();
        assert_eq!(feeder.finish().unwrap(), (false, Some("last".to_owned())));
        assert_eq!(std::fs::metadata(copy).unwrap().len(), 3_000_000);
        assert!(feeder.write_all(b"more").is_err());
        let mut early = Feeder::start(&shell("exit 0")).unwrap();
        let refused = (0..100).any(|_| early.write_all(&[7; 1 << 20]).is_err());
        assert!(refused, "nobody reads");
        assert_eq!(early.finish().unwrap(), (true, None));
    }

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let error = Stream::start(&Invocation::new("/nonexistent/tool")).unwrap_err();
        assert!(error.to_string().starts_with("cannot run `/nonexistent/tool`"), "{error}");
    }
}
