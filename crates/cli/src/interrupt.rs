// SPDX-License-Identifier: MIT OR Apache-2.0
//! The signals that ask the program to stop: Ctrl-C, SIGTERM (containers, Slurm, systemd) and
//! SIGHUP (a terminal that is closed). A thread receives them, whatever the command waits for.
//!
//! * Before [`flag`] is called, a command has nothing to keep, and the first signal ends it and its
//!   tools at once.
//! * After that, the first signal only makes a request. The command then keeps what is done, and
//!   ends by itself.
//! * A further signal ends the command at once, unless it is a repetition of the first one by
//!   another sender.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use foveate_toolchain::{Interrupt, Toolchain, end_all_families};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use thiserror::Error;

use crate::notice;

/// The number that shells add to that of the signal that ended a program.
const OF_SIGNALS: i32 = 128;
/// The time within which a second Ctrl-C is the first one again, passed on by `timeout` or a shell.
const SAME_KEY: Duration = Duration::from_millis(100);
/// The time within which any other signal is a repetition without a person behind it: `timeout`
/// sends two signals, systemd sends SIGTERM and SIGHUP.
const SAME_REQUEST: Duration = Duration::from_secs(1);

/// The error of a system that does not let the program listen for signals.
#[derive(Debug, Error)]
#[error("cannot listen for signals: {reason}")]
pub(crate) struct DeafError {
    reason: String,
}

/// The signals so far, and their meaning for the command.
struct SignalHistory {
    /// The first signal, and the time at which it came.
    first: Option<(i32, Instant)>,
    /// True if the command has results to keep, and so ends by itself.
    has_results: bool,
}

static REQUEST: LazyLock<Interrupt> = LazyLock::new(Interrupt::default);
static HEARD: Mutex<SignalHistory> = Mutex::new(SignalHistory { first: None, has_results: false });

fn heard() -> MutexGuard<'static, SignalHistory> {
    HEARD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts to listen for signals. Until [`flag`] is called, the first signal ends the process.
pub(crate) fn listen() -> Result<(), DeafError> {
    static LISTENING: OnceLock<Result<(), String>> = OnceLock::new();
    let listening = LISTENING.get_or_init(|| start().map_err(|error| error.to_string()));
    listening.clone().map_err(|reason| DeafError { reason })
}

/// Returns the flag that the first signal sets. A command calls this when it has begun work of
/// which something is kept, and then checks the flag.
pub(crate) fn flag() -> Result<Arc<AtomicBool>, DeafError> {
    listen()?;
    heard().has_results = true;
    Ok(REQUEST.flag())
}

/// Returns the request to stop, for everything that waits. A call does not mean that there are
/// results to keep.
pub(crate) fn request() -> Interrupt {
    REQUEST.clone()
}

/// Returns the exit code of a command that was told to stop: 130 after Ctrl-C, 143 after SIGTERM,
/// 129 after SIGHUP.
pub(crate) fn exit_code() -> u8 {
    // If only a tool was interrupted, this process has received no signal.
    let signal = heard().first.map_or(SIGINT, |(signal, _)| signal);
    code_of(signal).try_into().unwrap_or(u8::MAX)
}

fn code_of(signal: i32) -> i32 {
    OF_SIGNALS + signal
}

/// Returns the tools of this machine. The same signals stop them.
pub(crate) fn toolchain() -> Result<Toolchain, DeafError> {
    Ok(Toolchain::system().cancelled_by(flag()?))
}

fn start() -> io::Result<()> {
    let mut signals = Signals::new(heeded())?;
    let listener = std::thread::Builder::new().name("signals".to_owned());
    listener.spawn(move || signals.forever().for_each(hear)).map(drop)
}

fn hear(signal: i32) {
    let mut heard = heard();
    match heard.first {
        None => {
            heard.first = Some((signal, Instant::now()));
            REQUEST.flag().store(true, Ordering::Relaxed);
            if !heard.has_results {
                notice::say("interrupted; nothing was written");
                exit(signal);
            }
        }
        Some((first, when)) => {
            let same = if (first, signal) == (SIGINT, SIGINT) { SAME_KEY } else { SAME_REQUEST };
            if when.elapsed() >= same {
                exit(signal);
            }
        }
    }
}

/// Ends the process and all its tools at once, whatever they do.
fn exit(signal: i32) -> ! {
    end_all_families();
    signal_hook::low_level::exit(code_of(signal))
}

/// Returns the signals to listen for: all but those that were ignored at the start. `nohup` ignores
/// signals, and so does a shell for what it starts in the background of a script.
fn heeded() -> impl Iterator<Item = i32> {
    let ignored = ignored();
    SIGNALS.iter().copied().filter(move |signal| ignored >> (signal - 1) & 1 == 0)
}

#[cfg(unix)]
const SIGNALS: &[i32] = &[SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
#[cfg(not(unix))]
const SIGNALS: &[i32] = &[SIGINT, SIGTERM];

/// Returns a bit for every ignored signal, with signal 1 in the lowest bit; 0 if the system does
/// not provide them.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
