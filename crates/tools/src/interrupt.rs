// SPDX-License-Identifier: MIT OR Apache-2.0
//! A request to stop, which is checked during every wait: in reads of pipes, runs of tools, and
//! FIFOs without a writer. Each wait consists of short steps, so that a request is noticed within
//! [`POLL_STEP`].

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

/// The longest time between two checks of the request.
pub(crate) const POLL_STEP: Duration = Duration::from_millis(50);

/// A request to stop. Clones share it.
#[derive(Clone, Default)]
pub struct Interrupt {
    /// The flag of the user's request.
    flag: Arc<AtomicBool>,
    /// The flag that stops a part of the work alone.
    part: Option<Arc<AtomicBool>>,
}

impl Interrupt {
    /// Makes an interrupt from this flag.
    #[must_use]
    pub fn from_flag(flag: Arc<AtomicBool>) -> Self {
        Self { flag, part: None }
    }

    /// Returns an interrupt for a part of the work: this one stops it, too, and
    /// [`Interrupt::stop_part`] stops the part alone.
    #[must_use]
    pub fn of_part(&self) -> Self {
        Self { flag: Arc::clone(&self.flag), part: Some(Arc::default()) }
    }

    /// Stops the part of the work that has this interrupt or a clone of it. An interrupt that is
    /// not one of a part is unchanged.
    pub fn stop_part(&self) {
        if let Some(part) = &self.part {
            part.store(true, Ordering::Relaxed);
        }
    }

    /// Returns whether the work must stop.
    #[must_use]
    pub fn is_set(&self) -> bool {
        let is_set = |flag: &Arc<AtomicBool>| flag.load(Ordering::Relaxed);
        is_set(&self.flag) || self.part.as_ref().is_some_and(is_set)
    }

    /// Returns the flag of the user's request.
    #[must_use]
    pub fn flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.flag)
    }

    /// Returns whether the user's request comes now or within some milliseconds.
    pub(crate) fn is_set_soon(&self) -> bool {
        flag_is_set_soon(&self.flag)
    }
}

/// Returns whether a flag is set within some milliseconds. A signal that stops a job may go to all
/// of its processes, so a tool may end before the flag of this process is set.
pub(crate) fn flag_is_set_soon(flag: &AtomicBool) -> bool {
    let start = Instant::now();
    while !flag.load(Ordering::Relaxed) && start.elapsed() < Duration::from_millis(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
    flag.load(Ordering::Relaxed)
}

/// The text is the same whether the interrupt is set or not, because options that contain it are
/// compared by their text.
impl fmt::Debug for Interrupt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Interrupt")
    }
}

/// Returns the error of a read or write that an interrupt has ended. Its kind is not
/// [`io::ErrorKind::Interrupted`], after which the standard library tries again.
pub(crate) fn interrupted_error() -> io::Error {
    io::Error::other("interrupted")
}

/// Opens a file for reading. On a FIFO without a writer this waits until there is one, or until the
/// interrupt.
///
/// # Errors
/// Fails if the file cannot be opened, and on an interrupt.
pub fn open_interruptibly(path: &Path, interrupt: &Interrupt) -> io::Result<File> {
    if std::fs::metadata(path)?.is_file() {
        return crate::reading::open_file(path);
    }
    // A thread waits in `open` while this one checks the interrupt; the thread ends with the
    // process.
    let (sender, opened) = mpsc::channel();
    let owned = path.to_owned();
    let opener = std::thread::Builder::new().name("opener".to_owned());
    opener.spawn(move || sender.send(File::open(owned)))?;
    loop {
        match opened.recv_timeout(POLL_STEP) {
            Ok(opened) => return opened,
            Err(RecvTimeoutError::Timeout) if !interrupt.is_set() => {}
            Err(_) => return Err(interrupted_error()),
        }
    }
}

/// Returns the standard input as a file without a buffer of its own.
///
/// # Errors
/// Fails if the system has no free file descriptor.
#[cfg(unix)]
pub fn standard_input() -> io::Result<File> {
    use std::os::fd::AsFd as _;
    Ok(File::from(io::stdin().as_fd().try_clone_to_owned()?))
}

/// Returns the standard input.
///
/// # Errors
/// Never fails.
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
    /// Makes a reader that reads from `inner` until the interrupt.
    pub fn new(inner: T, interrupt: &Interrupt) -> Self {
        Self { inner, interrupt: interrupt.clone() }
    }
}

#[cfg(unix)]
impl<T: Read + std::os::fd::AsFd> Read for InterruptibleReader<T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let readable = rustix::event::PollFlags::IN;
        wait_until_ready(readable, &self.inner, &self.interrupt, Duration::ZERO)?;
        self.inner.read(bytes)
    }
}

/// On other systems a read in progress is not interrupted.
#[cfg(not(unix))]
impl<T: Read> Read for InterruptibleReader<T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        if self.interrupt.is_set() { Err(interrupted_error()) } else { self.inner.read(bytes) }
    }
}

/// Waits until a descriptor is ready. Fails once an interrupt is older than `grace`.
#[cfg(unix)]
pub(crate) fn wait_until_ready(
    ready: rustix::event::PollFlags,
    descriptor: &impl std::os::fd::AsFd,
    interrupt: &Interrupt,
    grace: Duration,
) -> io::Result<()> {
    use rustix::event::{PollFd, Timespec, poll};
    let step = Timespec { tv_sec: 0, tv_nsec: i64::from(POLL_STEP.subsec_nanos()) };
    let mut grace_period = GracePeriod::new(interrupt, grace);
    loop {
        if grace_period.is_over() {
            return Err(interrupted_error());
        }
        match poll(&mut [PollFd::new(descriptor, ready)], Some(&step)) {
            Ok(0) | Err(rustix::io::Errno::INTR) => {}
            Ok(_) => return Ok(()),
            Err(error) => return Err(error.into()),
        }
    }
}

/// The time for which a wait continues after an interrupt.
pub(crate) struct GracePeriod<'a> {
    interrupt: &'a Interrupt,
    grace: Duration,
    first_noticed: Option<Instant>,
}

impl<'a> GracePeriod<'a> {
    pub(crate) fn new(interrupt: &'a Interrupt, grace: Duration) -> Self {
        Self { interrupt, grace, first_noticed: None }
    }

    pub(crate) fn is_over(&mut self) -> bool {
        self.interrupt.is_set()
            && self.first_noticed.get_or_insert_with(Instant::now).elapsed() >= self.grace
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_stops_alone_and_with_the_whole_work() {
        let whole = Interrupt::default();
        let (one, other) = (whole.of_part(), whole.of_part());
        one.clone().stop_part();
        assert_eq!([&whole, &one, &other].map(Interrupt::is_set), [false, true, false]);
        whole.stop_part();
        assert!(!whole.is_set(), "it is no part");
        whole.flag().store(true, Ordering::Relaxed);
        assert!(other.is_set());
    }
}
