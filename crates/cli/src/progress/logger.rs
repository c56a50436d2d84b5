// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lines of progress for logs: the first after five seconds, then ever more rarely, and once a
//! minute at last.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use foveate_media::ProgressStage;

use super::lock_stage;
use super::stage_text::log_line;
use crate::notice;

/// The environment variable with the seconds between lines; `0` means no lines.
const INTERVAL_VARIABLE: &str = "FOVEATE_PROGRESS";
const FIRST_INTERVAL: Duration = Duration::from_secs(5);
const LAST_INTERVAL: Duration = Duration::from_secs(60);
const LONGEST_INTERVAL: u64 = 86_400;

/// The thread that prints the lines. It ends when this value is dropped.
pub(super) struct ProgressLogger {
    /// The sender whose drop ends the thread; `None` from then on.
    alive: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl ProgressLogger {
    /// Starts the thread, or returns `None` if the user wants no lines.
    pub(super) fn start(stage: Arc<Mutex<ProgressStage>>) -> Option<Self> {
        let asked = std::env::var(INTERVAL_VARIABLE).ok().filter(|text| !text.is_empty());
        let interval = match asked.as_deref().map(parse_interval) {
            Some(Some(Duration::ZERO)) => return None,
            Some(Some(interval)) => Some(interval),
            None => None,
            Some(None) => {
                let asked = asked.unwrap_or_default();
                notice::print_warning(&format!(
                    "{INTERVAL_VARIABLE} is `{asked}`; expected seconds between lines of progress, 0 (none) to {LONGEST_INTERVAL}"
                ));
                None
            }
        };
        let (alive, end) = mpsc::channel::<()>();
        let start = Instant::now();
        let tell = move || {
            loop {
                let pause = interval.unwrap_or_else(|| next_interval(start.elapsed()));
                if end.recv_timeout(pause) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
                let stage = lock_stage(&stage).clone();
                if let Some(line) = log_line(&stage, start, Instant::now()) {
                    notice::print_notice(&line);
                }
            }
        };
        // A system that starts no thread prints no lines, which is no reason to stop.
        let thread = std::thread::Builder::new().name("progress".to_owned()).spawn(tell).ok();
        Some(Self { alive: Some(alive), thread })
    }
}

impl Drop for ProgressLogger {
    fn drop(&mut self) {
        drop(self.alive.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Returns the time to the next line: as long as the command has taken so far, within bounds.
fn next_interval(elapsed: Duration) -> Duration {
    elapsed.clamp(FIRST_INTERVAL, LAST_INTERVAL)
}

fn parse_interval(text: &str) -> Option<Duration> {
    let seconds = text.trim().parse::<u64>().ok().filter(|&seconds| seconds <= LONGEST_INTERVAL)?;
    Some(Duration::from_secs(seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_ever_more_rarely() {
        let mut at = Duration::ZERO;
        let mut seconds = Vec::new();
        for _ in 0..7 {
            at += next_interval(at);
            seconds.push(at.as_secs());
        }
        assert_eq!(seconds, [5, 10, 20, 40, 80, 140, 200]);
    }

    #[test]
    fn the_variable_is_whole_seconds_up_to_a_day() {
        assert_eq!(parse_interval(" 30"), Some(Duration::from_secs(30)));
        assert_eq!(parse_interval("0"), Some(Duration::ZERO));
        for text in ["off", "-1", "1.5", "86401", "5s"] {
            assert_eq!(parse_interval(text), None, "{text}");
        }
    }
}
