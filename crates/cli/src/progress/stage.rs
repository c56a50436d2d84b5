// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a command is about, since when, and how long the rest of it takes at the pace of what is done.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

pub(super) const WORK: &str = "{spinner} {msg} [{elapsed}]";
pub(super) const STEPS: &str = "{msg} {wide_bar} {pos}/{len} [{elapsed}{left}]";
pub(super) const FRAMES: &str = "{spinner} {pos} frames [{elapsed}, {per_sec:.1}] {msg}";
pub(super) const FRAMES_OF_ALL: &str =
    "{wide_bar} {pos}/{len} frames [{elapsed}, {per_sec:.1}{left}] {msg}";

/// A pace is one only after so long: what comes first may lie in a cache, or start a tool.
const PACE_AFTER: Duration = Duration::from_secs(2);
/// A longer time is told as more than this: no run that is meant takes it.
const LONGEST: Duration = Duration::from_secs(7 * 24 * 3600);

/// What goes on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stage {
    /// The template that shows it; none before the command has said what it does.
    pub(super) style: Option<&'static str>,
    pub(super) what: String,
    /// When it began, and what was done of it by then.
    began: Instant,
    first: u64,
}

/// How long the rest takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Left {
    About(Duration),
    MoreThan(Duration),
}

impl Stage {
    pub(super) fn new(now: Instant) -> Self {
        Self { style: None, what: String::new(), began: now, first: 0 }
    }

    /// The next stage, or the same with other words. Steps of another kind have a pace of their own; notes
    /// beside frames change while these go on.
    pub(super) fn enter(&mut self, style: &'static str, what: &str, done: u64, now: Instant) {
        let same = self.style == Some(style) && (style != STEPS || self.what == what);
        if !same || done < self.first {
            (self.began, self.first) = (now, done);
        }
        self.style = Some(style);
        what.clone_into(&mut self.what);
    }

    /// How long the rest takes if it goes on as it has gone since the stage began; nothing before something
    /// of it is done, or when nothing is left. A step that takes long makes it longer little by little.
    pub(super) fn left(&self, done: u64, all: u64, now: Instant) -> Option<Left> {
        let elapsed = now.saturating_duration_since(self.began);
        let (fresh, rest) = (done.saturating_sub(self.first), all.saturating_sub(done));
        if fresh == 0 || rest == 0 || elapsed < PACE_AFTER {
            return None;
        }
        let millis = elapsed.as_millis() * u128::from(rest) / u128::from(fresh);
        Some(match u64::try_from(millis).map(Duration::from_millis) {
            Ok(left) if left <= LONGEST => Left::About(left),
            _ => Left::MoreThan(LONGEST),
        })
    }
}

/// The stage, whether or not a thread that held it has panicked: it is whole at any time.
pub(super) fn locked(stage: &Mutex<Stage>) -> MutexGuard<'_, Stage> {
    stage.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn the_rest_takes_as_long_as_what_is_done() {
        let start = Instant::now();
        let mut stage = Stage::new(start);
        stage.enter(STEPS, "designs", 0, start);
        let left = |done, seconds: u32| stage.left(done, 31, start + seconds * SECOND);
        assert_eq!(left(0, 100), None, "nothing is done");
        assert_eq!(left(10, 1), None, "too early");
        assert_eq!(left(31, 100), None, "nothing is left");
        assert_eq!(left(10, 100), Some(Left::About(210 * SECOND)));
        // Ten minutes without a step, and a day: no more than in proportion.
        assert_eq!(left(10, 700), Some(Left::About(1470 * SECOND)));
        assert_eq!(left(10, 86_500), Some(Left::About(181_650 * SECOND)));
    }

    #[test]
    fn no_time_is_longer_than_a_week() {
        let start = Instant::now();
        let mut stage = Stage::new(start);
        stage.enter(FRAMES_OF_ALL, "", 0, start);
        assert_eq!(stage.left(1, u64::MAX, start + 60 * SECOND), Some(Left::MoreThan(LONGEST)));
    }

    #[test]
    fn other_steps_have_a_pace_of_their_own_and_other_notes_have_not() {
        let start = Instant::now();
        let mut stage = Stage::new(start);
        stage.enter(STEPS, "fast", 0, start);
        stage.enter(STEPS, "fast", 90, start + 10 * SECOND);
        let then = start + 100 * SECOND;
        stage.enter(STEPS, "slow", 4, then);
        assert_eq!(stage.left(4, 10, then + 50 * SECOND), None);
        assert_eq!(stage.left(5, 10, then + 50 * SECOND), Some(Left::About(250 * SECOND)));
        stage.enter(FRAMES_OF_ALL, "1/2 clips", 0, then);
        stage.enter(FRAMES_OF_ALL, "2/2 clips", 50, then + 50 * SECOND);
        assert_eq!(stage.left(50, 60, then + 50 * SECOND), Some(Left::About(10 * SECOND)));
    }
}
