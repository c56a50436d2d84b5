// SPDX-License-Identifier: MIT OR Apache-2.0
//! Signals that ask to stop: Ctrl-C, SIGTERM (containers, Slurm, systemd) and SIGHUP (a terminal that is
//! closed). A thread hears them, whatever the command waits for.
//!
//! * A command that has nothing to keep yet ends at once, and so does every tool that it runs.
//! * From [`flag`] on, the first signal only makes a request, at which the command keeps what is done and ends by itself.
//! * A further signal ends it at once, if it is not the same that another sender repeats.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use foveate_toolchain::{Interrupt, Toolchain, end_all_families};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use thiserror::Error;

use crate::notice;

/// What shells add to the number of the signal that ended a program.
const OF_SIGNALS: i32 = 128;
/// A second Ctrl-C that comes sooner is the first, which `timeout` or a shell passes on.
const SAME_KEY: Duration = Duration::from_millis(100);
/// Other signals may come more than once without a person behind them (`timeout` sends two, systemd SIGTERM and SIGHUP).
const SAME_REQUEST: Duration = Duration::from_secs(1);

/// The system does not let signals be heard.
#[derive(Debug, Error)]
#[error("cannot listen for signals: {reason}")]
pub(crate) struct DeafError {
    reason: String,
}

/// The signals so far, and their meaning for the command.
struct SignalHistory {
    /// The first signal, and when it came.
    first: Option<(i32, Instant)>,
    /// Whether the command ends by itself.
    has_results: bool,
}

static REQUEST: LazyLock<Interrupt> = LazyLock::new(Interrupt::default);
static HEARD: Mutex<SignalHistory> = Mutex::new(SignalHistory { first: None, has_results: false });

fn heard() -> MutexGuard<'static, SignalHistory> {
    HEARD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Hears signals from here on. Until [`flag`] is asked for, the first ends the process.
pub(crate) fn listen() -> Result<(), DeafError> {
    static LISTENING: OnceLock<Result<(), String>> = OnceLock::new();
    let listening = LISTENING.get_or_init(|| start().map_err(|error| error.to_string()));
    listening.clone().map_err(|reason| DeafError { reason })
}

/// A flag that the first signal sets, for a command that has begun work of which something is kept, and looks at the
/// flag.
pub(crate) fn flag() -> Result<Arc<AtomicBool>, DeafError> {
    listen()?;
    heard().has_results = true;
    Ok(REQUEST.flag())
}

/// The same for everything that waits; by itself it does not mean that there is something to keep.
pub(crate) fn request() -> Interrupt {
    REQUEST.clone()
}

/// The exit code of a command that was told to stop: 130 after Ctrl-C, 143 after SIGTERM, 129 after SIGHUP.
pub(crate) fn exit_code() -> u8 {
    // Where a tool was interrupted without us there is no number.
    let signal = heard().first.map_or(SIGINT, |(signal, _)| signal);
    code_of(signal).try_into().unwrap_or(u8::MAX)
}

fn code_of(signal: i32) -> i32 {
    OF_SIGNALS + signal
}

/// The tools of this machine, stopped by the same signals.
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

/// Ends the process, and every tool with it, without a look at what it does.
fn exit(signal: i32) -> ! {
    end_all_families();
    signal_hook::low_level::exit(code_of(signal))
}

/// All but those that are ignored since the start: `nohup` does so, and a shell for what it starts in the
/// background of a script.
fn heeded() -> impl Iterator<Item = i32> {
    let ignored = ignored();
    SIGNALS.iter().copied().filter(move |signal| ignored >> (signal - 1) & 1 == 0)
}

#[cfg(unix)]
const SIGNALS: &[i32] = &[SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
#[cfg(not(unix))]
const SIGNALS: &[i32] = &[SIGINT, SIGTERM];

/// A bit for every signal that is ignored, that of signal 1 being the lowest; none where the system does not
/// tell.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
