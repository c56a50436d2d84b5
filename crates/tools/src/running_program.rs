// SPDX-License-Identifier: MIT OR Apache-2.0
//! A program whose output is read, or whose input is written, while it runs. The data pass through
//! a pipe at the speed of the slower side, and the messages of the program are collected line by
//! line.
//!
//! The program cannot block forever: a thread always empties its standard error, and the pipe fills
//! up only while its reader is slower. The program does not outlive its [`ProgramReader`] or
//! [`ProgramWriter`]. Ctrl-C in the terminal does not reach it, so this process decides how it
//! ends. Every wait for it ends on an [`Interrupt`].

use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use super::process::ProcessFamily;
use crate::error::ToolError;
use crate::interrupt::{GracePeriod, Interrupt, InterruptibleReader, POLL_STEP};
use crate::invocation::Invocation;

/// The number of bytes of a line that are kept. The rest of the line is dropped, so that it cannot
/// appear as a line of its own.
const LINE_BYTES: u64 = 1 << 14;
/// The time for which a fed program may accept no input after an interrupt.
const INPUT_GRACE: Duration = Duration::from_secs(1);
/// The time in which a fed program may complete its output after an interrupt. Encoders hold back
/// some dozen frames.
const ENDING_GRACE: Duration = Duration::from_secs(10);

/// A running program and its messages.
#[derive(Debug)]
struct RunningProgram {
    family: ProcessFamily,
    lines: Receiver<String>,
    interrupt: Interrupt,
}

/// A running program whose standard output is read.
#[derive(Debug)]
pub struct ProgramReader {
    running: RunningProgram,
    stdout: InterruptibleReader<ChildStdout>,
}

/// A running program whose standard input is written.
#[derive(Debug)]
pub struct ProgramWriter {
    running: RunningProgram,
    /// The pipe; `None` once the input has ended.
    stdin: Option<ChildStdin>,
}

impl ProgramReader {
    /// Starts a program with an empty standard input; a time limit does not apply.
    ///
    /// # Errors
    /// Fails if the program cannot be started.
    pub fn start(invocation: &Invocation, interrupt: &Interrupt) -> Result<Self, ToolError> {
        let mut running =
            RunningProgram::start(invocation, interrupt, Stdio::null(), Stdio::piped())?;
        let stdout =
            running.family.leader.stdout.take().ok_or_else(|| missing_pipe_error(invocation))?;
        enlarge_pipe(&stdout);
        Ok(Self { running, stdout: InterruptibleReader::new(stdout, interrupt) })
    }

    /// Waits for the next line of the standard error and returns it. Returns `None` if no more
    /// lines follow.
    ///
    /// # Errors
    /// Fails with [`ToolError::Interrupted`] on an interrupt.
    pub fn next_line(&self) -> Result<Option<String>, ToolError> {
        self.running.next_line(None)
    }

    /// Waits for the next line as [`ProgramReader::next_line`] does, but not longer than `limit`.
    ///
    /// # Errors
    /// Fails with [`ToolError::Silent`] after this time, and like [`ProgramReader::next_line`].
    pub fn next_line_within(&self, limit: Duration) -> Result<Option<String>, ToolError> {
        self.running.next_line(Some(limit))
    }

    /// Waits for the end of the program, after its output has been read. Returns whether the exit
    /// code is zero, and the exit code or signal as words.
    ///
    /// # Errors
    /// Fails with [`ToolError::Interrupted`] on an interrupt, even if the program ends before the
    /// interrupt is set, and fails if the system does not report the end.
    pub fn finish(&mut self) -> Result<(bool, String), ToolError> {
        let status = self.running.wait(Duration::ZERO)?;
        if !status.success() && self.running.interrupt.is_set_soon() {
            return Err(ToolError::Interrupted);
        }
        Ok((status.success(), status.to_string()))
    }

    /// Ends the program, whatever it was about to write.
    pub fn stop(&mut self) {
        self.running.family.end();
    }
}

impl Read for ProgramReader {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stdout.read(bytes)
    }
}

impl ProgramWriter {
    /// Starts a program whose standard output is discarded; a time limit does not apply.
    ///
    /// # Errors
    /// Fails if the program cannot be started.
    pub fn start(invocation: &Invocation, interrupt: &Interrupt) -> Result<Self, ToolError> {
        let mut running =
            RunningProgram::start(invocation, interrupt, Stdio::piped(), Stdio::null())?;
        let stdin =
            running.family.leader.stdin.take().ok_or_else(|| missing_pipe_error(invocation))?;
        enlarge_pipe(&stdin);
        set_nonblocking(&stdin).map_err(ToolError::io("run", &invocation.program))?;
        Ok(Self { running, stdin: Some(stdin) })
    }

    /// Ends the input and waits for the end of the program. Returns whether the exit code is zero,
    /// and the last line of the standard error that is not blank, if any. After an interrupt, the
    /// program has ten seconds left.
    ///
    /// # Errors
    /// Fails if the program does not end in time, or if the system does not report the end.
    pub fn finish(&mut self) -> Result<(bool, Option<String>), ToolError> {
        drop(self.stdin.take());
        let is_success = self.running.wait(ENDING_GRACE)?.success();
        let messages = self.running.lines.iter().filter(|line| !line.trim().is_empty());
        Ok((is_success, messages.last()))
    }
}

impl ProgramWriter {
    /// Handles a write that failed, and returns the last line of the program's messages. The
    /// program is ended at once if an interrupt is set. Otherwise it has ten seconds to end by
    /// itself, because it takes no more input.
    ///
    /// # Errors
    /// Fails like [`ProgramWriter::finish`].
    pub fn finish_after_failed_write(&mut self) -> Result<Option<String>, ToolError> {
        self.finish_within(ENDING_GRACE)
    }

    fn finish_within(&mut self, limit: Duration) -> Result<Option<String>, ToolError> {
        drop(self.stdin.take());
        if self.running.interrupt.is_set() || !self.running.ends_within(limit)? {
            self.running.family.end();
        }
        Ok(self.finish()?.1)
    }
}

impl Write for ProgramWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let stdin = self.stdin.as_mut().ok_or(io::ErrorKind::BrokenPipe)?;
        loop {
            match stdin.write(bytes) {
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                    wait_for_room(stdin, &self.running.interrupt)?;
                }
                written => return written,
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl RunningProgram {
    fn start(
        invocation: &Invocation,
        interrupt: &Interrupt,
        stdin: Stdio,
        stdout: Stdio,
    ) -> Result<Self, ToolError> {
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
        let started = ProcessFamily::start(&mut command);
        let family = started.map_err(ToolError::io("run", &invocation.program))?;
        let (sender, lines) = mpsc::channel();
        let mut running = Self { family, lines, interrupt: interrupt.clone() };
        let stderr =
            running.family.leader.stderr.take().ok_or_else(|| missing_pipe_error(invocation))?;
        let collector = std::thread::Builder::new().name("stderr of a tool".to_owned());
        let collector = collector.spawn(move || collect_lines(stderr, &sender));
        collector.map_err(ToolError::io("run", &invocation.program))?;
        Ok(running)
    }

    fn next_line(&self, limit: Option<Duration>) -> Result<Option<String>, ToolError> {
        let start = Instant::now();
        loop {
            if self.interrupt.is_set() {
                return Err(ToolError::Interrupted);
            }
            match self.lines.recv_timeout(POLL_STEP) {
                Ok(line) => return Ok(Some(line)),
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {
                    if let Some(limit) = limit.filter(|&limit| start.elapsed() >= limit) {
                        return Err(ToolError::Silent { limit });
                    }
                }
            }
        }
    }

    /// Waits for the end of the program; ends it once an interrupt is older than `grace`.
    fn wait(&mut self, grace: Duration) -> Result<ExitStatus, ToolError> {
        let interrupt = self.interrupt.clone();
        let mut grace_period = GracePeriod::new(&interrupt, grace);
        let status = self.wait_until(|| grace_period.is_over())?;
        status.ok_or_else(|| {
            self.family.end();
            ToolError::Interrupted
        })
    }

    /// Waits for the end of the program until `limit` is over or an interrupt is set. Returns
    /// whether the program has ended.
    fn ends_within(&mut self, limit: Duration) -> Result<bool, ToolError> {
        let (interrupt, start) = (self.interrupt.clone(), Instant::now());
        let status = self.wait_until(|| interrupt.is_set() || start.elapsed() >= limit)?;
        Ok(status.is_some())
    }

    /// Waits for the end of the program, or until `is_over`, which is asked every few milliseconds.
    fn wait_until(
        &mut self,
        mut is_over: impl FnMut() -> bool,
    ) -> Result<Option<ExitStatus>, ToolError> {
        let failed =
            |source| ToolError::Io { action: "wait for", path: "the end of a tool".into(), source };
        let mut pause = Duration::from_micros(200);
        loop {
            let status = self.family.try_wait().map_err(failed)?;
            if status.is_some() || is_over() {
                return Ok(status);
            }
            std::thread::sleep(pause);
            pause = (pause * 2).min(Duration::from_millis(10));
        }
    }
}

fn missing_pipe_error(invocation: &Invocation) -> ToolError {
    ToolError::io("run", &invocation.program)(io::Error::other("its pipes are missing"))
}

/// Makes a pipe large enough for about a frame of video, so that its two sides wake each other less
/// often.
#[cfg(target_os = "linux")]
fn enlarge_pipe(pipe: &impl std::os::fd::AsFd) {
    /// The size that the system allows every user by default.
    const BYTES: usize = 1 << 20;
    // If the system refuses, the pipe works with its previous size.
    let _ = rustix::pipe::fcntl_setpipe_size(pipe, BYTES);
}

/// Does nothing: the size of a pipe is changed only on Linux.
#[cfg(not(target_os = "linux"))]
fn enlarge_pipe<T>(_: &T) {}

/// Makes writes return at once if the pipe is full. The other side has its own file description and
/// is unaffected.
#[cfg(unix)]
fn set_nonblocking(pipe: &ChildStdin) -> io::Result<()> {
    Ok(rustix::io::ioctl_fionbio(pipe, true)?)
}

#[cfg(unix)]
fn wait_for_room(pipe: &ChildStdin, interrupt: &Interrupt) -> io::Result<()> {
    let writable = rustix::event::PollFlags::OUT;
    crate::interrupt::wait_until_ready(writable, pipe, interrupt, INPUT_GRACE)
}

/// Does nothing: on other systems a write waits until it is done.
#[cfg(not(unix))]
fn set_nonblocking(_: &ChildStdin) -> io::Result<()> {
    Ok(())
}

#[cfg(not(unix))]
fn wait_for_room(_: &ChildStdin, _: &Interrupt) -> io::Result<()> {
    Err(crate::interrupt::interrupted_error())
}

fn collect_lines(stderr: ChildStderr, lines: &Sender<String>) {
    let mut reader = BufReader::new(stderr);
    let (mut line, mut is_continued) = (Vec::new(), false);
    while matches!(reader.by_ref().take(LINE_BYTES).read_until(b'\n', &mut line), Ok(1..)) {
        let is_complete = line.ends_with(b"\n");
        if !is_continued {
            // A send fails when the receiver is gone; the pipe is still emptied.
            let _ = lines.send(String::from_utf8_lossy(&line).trim_end().to_owned());
        }
        is_continued = !is_complete;
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
        let mut stream = ProgramReader::start(&shell(script), &Interrupt::default()).unwrap();
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).unwrap();
        assert_eq!(bytes.len(), 3_000_000);
        let lines: Vec<String> = std::iter::from_fn(|| stream.next_line().unwrap()).collect();
        assert_eq!(lines.last().map(String::as_str), Some("last"));
        assert_eq!(lines.iter().map(String::len).collect::<Vec<_>>(), [1 << 14, 4]);
        assert_eq!(stream.finish().unwrap(), (false, "exit status: 3".to_owned()));
    }

    #[test]
    fn a_silent_program_is_not_waited_for() {
        let script = "echo one >&2; exec sleep 60";
        let stream = ProgramReader::start(&shell(script), &Interrupt::default()).unwrap();
        let limit = Duration::from_secs(5);
        assert_eq!(stream.next_line_within(limit).unwrap().as_deref(), Some("one"));
        let silent = stream.next_line_within(Duration::from_millis(20)).unwrap_err();
        assert!(matches!(silent, ToolError::Silent { .. }), "{silent}");
    }

    #[test]
    fn a_stream_that_is_dropped_ends_its_program() {
        let stream =
            ProgramReader::start(&shell("echo $$ >&2; exec sleep 60"), &Interrupt::default())
                .unwrap();
        let pid = stream.next_line().unwrap().unwrap();
        drop(stream);
        let alive = Command::new("kill").args(["-0", &pid]).stderr(Stdio::null()).status();
        assert!(!alive.unwrap().success());
    }

    #[test]
    fn a_fed_program_ends_with_its_input_and_its_last_line_is_kept() {
        let dir = tempfile::tempdir().unwrap();
        let copy = dir.path().join("copy");
        let script = format!("cat > '{}'; echo first >&2; echo last >&2; exit 3", copy.display());
        let mut writer = ProgramWriter::start(&shell(&script), &Interrupt::default()).unwrap();
        writer.write_all(&[7; 3_000_000]).unwrap();
        assert_eq!(writer.finish().unwrap(), (false, Some("last".to_owned())));
        assert_eq!(std::fs::metadata(copy).unwrap().len(), 3_000_000);
        assert!(writer.write_all(b"more").is_err());
        let mut ended_program =
            ProgramWriter::start(&shell("exit 0"), &Interrupt::default()).unwrap();
        let is_refused = (0..100).any(|_| ended_program.write_all(&[7; 1 << 20]).is_err());
        assert!(is_refused, "nobody reads");
        assert_eq!(ended_program.finish().unwrap(), (true, None));
    }

    /// A program that closes its input and keeps running is ended after the grace period.
    #[test]
    fn a_program_that_takes_no_more_input_has_a_limited_time_to_end() {
        let script = "exec <&-; echo closed >&2; sleep 60";
        let mut writer = ProgramWriter::start(&shell(script), &Interrupt::default()).unwrap();
        let is_refused = (0..100).any(|_| {
            std::thread::sleep(Duration::from_millis(10));
            writer.write_all(&[7; 1 << 20]).is_err()
        });
        assert!(is_refused, "the program has closed its input");
        let (start, limit) = (Instant::now(), Duration::from_millis(300));
        assert_eq!(writer.finish_within(limit).unwrap(), Some("closed".to_owned()));
        assert!(start.elapsed() < limit + Duration::from_secs(5), "{:?}", start.elapsed());
    }

    #[test]
    fn the_error_names_a_missing_program() {
        let error =
            ProgramReader::start(&Invocation::new("/nonexistent/tool"), &Interrupt::default())
                .unwrap_err();
        assert!(error.to_string().starts_with("cannot run `/nonexistent/tool`"), "{error}");
    }

    /// An interrupt gives up a program that does nothing: at once while it is read, after the grace
    /// period while it is fed.
    #[test]
    fn an_interrupt_ends_every_wait() {
        let interrupt = Interrupt::default();
        let set_interrupt = || interrupt.flag().store(true, std::sync::atomic::Ordering::Relaxed);
        let (line, bytes, end) = ["sleep 60", "sleep 60", "exec >&- 2>&-; sleep 60"]
            .map(|script| ProgramReader::start(&shell(script), &interrupt).unwrap())
            .into();
        let mut writer = ProgramWriter::start(&shell("sleep 60"), &interrupt).unwrap();
        let start = Instant::now();
        std::thread::scope(|scope| {
            let waits = [
                scope.spawn(move || line.next_line().unwrap_err().is_interrupted()),
                scope.spawn(move || {
                    let mut bytes = bytes;
                    bytes.read(&mut [0]).is_err()
                }),
                scope.spawn(move || {
                    let mut end = end;
                    end.finish().unwrap_err().is_interrupted()
                }),
                scope.spawn(move || writer.write_all(&[7; 3_000_000]).is_err()),
            ];
            std::thread::sleep(Duration::from_millis(300));
            assert!(waits.iter().all(|wait| !wait.is_finished()), "all of them wait");
            set_interrupt();
            assert!(waits.into_iter().all(|wait| wait.join().unwrap()));
        });
        assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    }
}
