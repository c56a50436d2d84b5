// SPDX-License-Identifier: MIT OR Apache-2.0
//! Signals that ask to stop: Ctrl-C, SIGTERM (containers, Slurm, systemd) and SIGHUP (a terminal that is
//! closed). Every command looks at one flag, so that nothing half-done is left behind.

use std::io;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use foveate_toolchain::Toolchain;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::{register, register_conditional_shutdown, register_usize};
use thiserror::Error;

/// What shells add to the number of the signal that ended a program.
const OF_SIGNALS: u8 = 128;
/// The number of Ctrl-C everywhere.
const KEYBOARD: u8 = 2;

/// The system does not let signals be heard.
#[derive(Debug, Error)]
#[error("cannot listen for signals: {reason}")]
pub(crate) struct DeafError {
    reason: String,
}

static SIGNAL: OnceLock<Arc<AtomicUsize>> = OnceLock::new();

/// A flag that the first signal sets. A second Ctrl-C ends the process at once; SIGTERM and SIGHUP may come
/// more than once without a person behind it (`timeout` sends two).
pub(crate) fn flag() -> Result<Arc<AtomicBool>, DeafError> {
    static LISTENING: OnceLock<Result<Arc<AtomicBool>, String>> = OnceLock::new();
    LISTENING
        .get_or_init(|| listen().map_err(|error| error.to_string()))
        .clone()
        .map_err(|reason| DeafError { reason })
}

/// The exit code of a command that was told to stop: 130 after Ctrl-C, 143 after SIGTERM, 129 after SIGHUP.
pub(crate) fn exit_code() -> u8 {
    let signal = SIGNAL.get().map_or(0, |signal| signal.load(Ordering::Relaxed));
    // Where a tool was interrupted without us there is no number.
    OF_SIGNALS + u8::try_from(signal).ok().filter(|&signal| signal != 0).unwrap_or(KEYBOARD)
}

/// The tools of this machine, stopped by the same signals.
pub(crate) fn toolchain() -> Result<Toolchain, DeafError> {
    Ok(Toolchain::system().cancelled_by(flag()?))
}

fn listen() -> io::Result<Arc<AtomicBool>> {
    let flag = Arc::<AtomicBool>::default();
    let number = Arc::clone(SIGNAL.get_or_init(Arc::default));
    for signal in heeded() {
        if signal == SIGINT {
            // Before the flag of the first Ctrl-C, so that only a second one finds it set.
            let pressed = Arc::<AtomicBool>::default();
            let code = i32::from(OF_SIGNALS + KEYBOARD);
            register_conditional_shutdown(signal, code, Arc::clone(&pressed))?;
            register(signal, pressed)?;
        }
        register_usize(
            signal,
            Arc::clone(&number),
            usize::try_from(signal).expect("a signal has a positive number"),
        )?;
        register(signal, Arc::clone(&flag))?;
    }
    Ok(flag)
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
