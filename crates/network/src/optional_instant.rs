// SPDX-License-Identifier: MIT OR Apache-2.0
//! A start time that also exists where there is no clock.

use std::time::{Duration, Instant};

/// A point in time. WebAssembly without an operating system has no clock, and asking for the time
/// would stop the program. On that target all durations are 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OptionalInstant(Option<Instant>);

impl OptionalInstant {
    pub(crate) fn now() -> Self {
        let has_clock = !cfg!(all(target_family = "wasm", target_os = "unknown"));
        Self(has_clock.then(Instant::now))
    }

    /// The time since this point.
    pub(crate) fn elapsed(self) -> Duration {
        self.0.map_or(Duration::ZERO, |start| start.elapsed())
    }
}
