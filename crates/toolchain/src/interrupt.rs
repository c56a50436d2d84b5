// SPDX-License-Identifier: MIT OR Apache-2.0
//! A request to stop, which everything that waits looks at: reads of pipes, runs of tools, FIFOs without a
//! writer. Waiting is done in short steps, so that a request is seen within [`STEP`].

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

/// The longest wait without a look at the request.
pub(crate) const STEP: Duration = Duration::from_millis(50);

/// A request to stop. Clones share it.
#[derive(Clone, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// A request that this flag makes.
    #[must_use]
    pub fn of(flag: Arc<AtomicBool>) -> Self {
        Self(flag)
    }

    /// Whether the work is to stop.
    #[must_use]
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// The flag itself.
    #[must_use]
    pub fn flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.0)
    }

    /// Whether it is set now or within some milliseconds.
    pub(crate) fn is_set_soon(&self) -> bool {
        soon(&self.0)
    }
}

/// Whether a flag is set within some milliseconds: whoever stops a job may tell every process of it, and a tool may
/// have ended before this process has heard.
pub(crate) fn soon(flag: &AtomicBool) -> bool {
    let start = Instant::now();
    while !flag.load(Ordering::Relaxed) && start.elapsed() < Duration::from_millis(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
    flag.load(Ordering::Relaxed)
}

/// The same whether it is set or not: options that hold it are compared by their text.
impl fmt::Debug for Interrupt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Interrupt")
    }
}

/// The error of a read or write that an interrupt has ended. Its kind is not [`io::ErrorKind::Interrupted`], after
/// which the standard library tries again.
pub(crate) fn interrupted() -> io::Error {
    io::Error::other("interrupted")
}

/// Opens a file to read. A FIFO that nobody writes to yet is waited for until the interrupt.
///
/// # Errors
/// When the file cannot be opened, and on an interrupt.
pub fn open_interruptibly(path: &Path, interrupt: &Interrupt) -> io::Result<File> {
    if std::fs::metadata(path)?.is_file() {
        return File::open(path);
    }
    // Only a thread can wait in `open` while another looks at the interrupt; it ends with the process.
    let (sender, opened) = mpsc::channel();
    let owned = path.to_owned();
    let opener = std::thread::Builder::new().name("opener".to_owned());
    opener.spawn(move || sender.send(File::open(owned)))?;
    loop {
        match opened.recv_timeout(STEP) {
            Ok(opened) => return opened,
            Err(RecvTimeoutError::Timeout) if !interrupt.is_set() => {}
            Err(_) => return Err(interrupted()),
        }
    }
}

/// The standard input, as a file without a buffer of its own.
///
/// # Errors
/// When the system has no further file descriptor.
#[cfg(unix)]
pub fn standard_input() -> io::Result<File> {
    use std::os::fd::AsFd as _;
    Ok(File::from(io::stdin().as_fd().try_clone_to_owned()?))
}

/// The standard input.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub fn standard_input() -> io::Result<io::Stdin> {
    Ok(io::stdin())
}

/// A pipe, file or terminal whose reads end with an error when an interrupt comes.
#[derive(Debug)]
pub struct InterruptibleReader<T> {
    inner: T,
    interrupt: Interrupt,
}

impl<T> InterruptibleReader<T> {
    /// Reads from `inner` until the interrupt.
    pub fn new(inner: T, interrupt: &Interrupt) -> Self {
        Self { inner, interrupt: interrupt.clone() }
    }
}

#[cfg(unix)]
impl<T: Read + std::os::fd::AsFd> Read for InterruptibleReader<T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let readable = rustix::event::PollFlags::IN;
        wait_until(readable, &self.inner, &self.interrupt, Duration::ZERO)?;
        self.inner.read(bytes)
    }
}

/// Elsewhere a read that has begun goes on.
#[cfg(not(unix))]
impl<T: Read> Read for InterruptibleReader<T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        if self.interrupt.is_set() { Err(interrupted()) } else { self.inner.read(bytes) }
    }
}

/// Waits until a descriptor is ready, or an interrupt is older than `grace`.
#[cfg(unix)]
pub(crate) fn wait_until(
    ready: rustix::event::PollFlags,
    descriptor: &impl std::os::fd::AsFd,
    interrupt: &Interrupt,
    grace: Duration,
) -> io::Result<()> {
    use rustix::event::{PollFd, Timespec, poll};
    let step = Timespec { tv_sec: 0, tv_nsec: i64::from(STEP.subsec_nanos()) };
    let mut patience = GracePeriod::new(interrupt, grace);
    loop {
        if patience.is_over() {
            return Err(interrupted());
        }
        match poll(&mut [PollFd::new(descriptor, ready)], Some(&step)) {
            Ok(0) | Err(rustix::io::Errno::INTR) => {}
            Ok(_) => return Ok(()),
            Err(error) => return Err(error.into()),
        }
    }
}

/// How long something is waited for once an interrupt has come.
pub(crate) struct GracePeriod<'a> {
    interrupt: &'a Interrupt,
    grace: Duration,
    seen: Option<Instant>,
}

impl<'a> GracePeriod<'a> {
    pub(crate) fn new(interrupt: &'a Interrupt, grace: Duration) -> Self {
        Self { interrupt, grace, seen: None }
    }

    pub(crate) fn is_over(&mut self) -> bool {
        self.interrupt.is_set()
            && self.seen.get_or_insert_with(Instant::now).elapsed() >= self.grace
    }
}
