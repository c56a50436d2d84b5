// SPDX-License-Identifier: MIT OR Apache-2.0
//! The signals that ask the program to stop: Ctrl-C, SIGTERM (containers, Slurm, systemd) and
//! SIGHUP (a terminal that is closed). A thread receives them, whatever the command waits for.
//!
//! * Before [`stop_flag`] is called, a command has nothing to keep, and the first signal ends it
//!   and its tools at once.
//! * After that, the first signal only makes a request. The command then keeps what is done, and
//!   ends by itself.
//! * A further signal ends the command at once, unless it is a repetition of the first one by
//!   another sender.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use foveate_tools::{Interrupt, Toolchain, end_all_process_families};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use thiserror::Error;

use crate::notice;

/// The number that shells add to that of the signal that ended a program.
const SIGNAL_CODE_BASE: i32 = 128;
/// The time within which a second Ctrl-C is the first one again, passed on by `timeout` or a shell.
const REPEATED_KEY_TIME: Duration = Duration::from_millis(100);
/// The time within which any other signal is a repetition without a person behind it: `timeout`
/// sends two signals, systemd sends SIGTERM and SIGHUP.
const REPEATED_SIGNAL_TIME: Duration = Duration::from_secs(1);

/// The error of a system that does not let the program listen for signals.
#[derive(Debug, Error)]
#[error("cannot listen for signals: {reason}")]
pub(crate) struct SignalError {
    reason: String,
}

/// The signals so far, and their meaning for the command.
struct SignalHistory {
    /// The first signal, and the time at which it came.
    first: Option<(i32, Instant)>,
    /// True if the command has results to keep, and so ends by itself.
    has_results: bool,
}

static STOP_REQUEST: LazyLock<Interrupt> = LazyLock::new(Interrupt::default);
static SIGNAL_HISTORY: Mutex<SignalHistory> =
    Mutex::new(SignalHistory { first: None, has_results: false });

fn signal_history() -> MutexGuard<'static, SignalHistory> {
    SIGNAL_HISTORY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts to listen for signals. Until [`stop_flag`] is called, the first signal ends the process.
pub(crate) fn listen() -> Result<(), SignalError> {
    static LISTENING: OnceLock<Result<(), String>> = OnceLock::new();
    let listening = LISTENING.get_or_init(|| start_listener().map_err(|error| error.to_string()));
    listening.clone().map_err(|reason| SignalError { reason })
}

/// Returns the flag that the first signal sets. A command calls this when it has begun work of
/// which something is kept, and then checks the flag.
pub(crate) fn stop_flag() -> Result<Arc<AtomicBool>, SignalError> {
    listen()?;
    signal_history().has_results = true;
    Ok(STOP_REQUEST.flag())
}

/// Returns the request to stop, for everything that waits. A call does not mean that there are
/// results to keep.
pub(crate) fn stop_request() -> Interrupt {
    STOP_REQUEST.clone()
}

/// Returns the exit code of a command that was told to stop: 130 after Ctrl-C, 143 after SIGTERM,
/// 129 after SIGHUP.
pub(crate) fn exit_code() -> u8 {
    // If only a tool was interrupted, this process has received no signal.
    let signal = signal_history().first.map_or(SIGINT, |(signal, _)| signal);
    signal_exit_code(signal).try_into().unwrap_or(u8::MAX)
}

fn signal_exit_code(signal: i32) -> i32 {
    SIGNAL_CODE_BASE + signal
}

/// Returns the tools of this machine. The same signals stop them.
pub(crate) fn toolchain() -> Result<Toolchain, SignalError> {
    Ok(Toolchain::system().with_cancel_flag(stop_flag()?))
}

fn start_listener() -> io::Result<()> {
    let mut signals = Signals::new(handled_signals())?;
    let listener = std::thread::Builder::new().name("signals".to_owned());
    listener.spawn(move || signals.forever().for_each(handle_signal)).map(drop)
}

fn handle_signal(signal: i32) {
    let mut heard = signal_history();
    match heard.first {
        None => {
            heard.first = Some((signal, Instant::now()));
            STOP_REQUEST.flag().store(true, Ordering::Relaxed);
            if !heard.has_results {
                notice::print_notice("interrupted; nothing was written");
                exit_at_once(signal);
            }
        }
        Some((first, when)) => {
            let same = if (first, signal) == (SIGINT, SIGINT) {
                REPEATED_KEY_TIME
            } else {
                REPEATED_SIGNAL_TIME
            };
            if when.elapsed() >= same {
                exit_at_once(signal);
            }
        }
    }
}

/// Ends the process and all its tools at once, whatever they do.
fn exit_at_once(signal: i32) -> ! {
    end_all_process_families();
    signal_hook::low_level::exit(signal_exit_code(signal))
}

/// Returns the signals to listen for: all but those that were ignored at the start. `nohup` ignores
/// signals, and so does a shell for what it starts in the background of a script.
fn handled_signals() -> impl Iterator<Item = i32> {
    let ignored = ignored_signals();
    SIGNALS.iter().copied().filter(move |signal| ignored >> (signal - 1) & 1 == 0)
}

#[cfg(unix)]
const SIGNALS: &[i32] = &[SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
#[cfg(not(unix))]
const SIGNALS: &[i32] = &[SIGINT, SIGTERM];

/// Returns a bit for every ignored signal, with signal 1 in the lowest bit; 0 if the system does
/// not provide them.
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
