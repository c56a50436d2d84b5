// SPDX-License-Identifier: MIT OR Apache-2.0
//! Commands that serve a page. They print its link, and then notices until they are stopped.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::Duration;

use crate::error::CliError;
use crate::{interrupt, notice, output};

/// The time between two checks for notices.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// A command that serves a page. It listens for signals before it opens anything.
pub(crate) struct ServingCommand {
    interrupted: Arc<AtomicBool>,
}

impl ServingCommand {
    pub(crate) fn new() -> Result<Self, CliError> {
        Ok(Self { interrupted: interrupt::stop_flag()? })
    }

    /// Prints the link, and then the notices until a signal comes.
    pub(crate) fn run_until_stopped(
        self,
        link: &str,
        news: impl Fn() -> Vec<String>,
        frames: impl Fn() -> u64,
    ) -> Result<(), CliError> {
        output::print_text(&format!("{link}\n"))?;
        while !self.interrupted.load(Ordering::Relaxed) {
            for text in news() {
                notice::print_notice(&text);
            }
            sleep(POLL_INTERVAL);
        }
        Err(CliError::Stopped { done: format!("{} frames", frames()) })
    }
}
