// SPDX-License-Identifier: MIT OR Apache-2.0
//! When something happened, as far as there is a clock.

use std::time::{Duration, Instant};

/// A moment. WebAssembly alone has no clock, and asking it for one would stop the program: there all spans are 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment(Option<Instant>);

impl Moment {
    pub(crate) fn now() -> Self {
        let has_clock = !cfg!(all(target_family = "wasm", target_os = "unknown"));
        Self(has_clock.then(Instant::now))
    }

    /// How long ago that is.
    pub(crate) fn elapsed(self) -> Duration {
        self.0.map_or(Duration::ZERO, |start| start.elapsed())
    }
}
