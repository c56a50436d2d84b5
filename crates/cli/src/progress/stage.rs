// SPDX-License-Identifier: MIT OR Apache-2.0
//! A stage of a command: its task, the amount that is done, its start, its rate, and the time that
//! is left.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The time after which a rate is computed. Before, results may come from a cache, or a tool may
/// start.
const PACE_AFTER: Duration = Duration::from_secs(2);
/// The longest time that is shown as it is. A longer time is shown as more than this, because no
/// meaningful run takes so long.
pub(super) const LONGEST_REMAINING: Duration = Duration::from_secs(7 * 24 * 3600);

/// The unit in which a stage counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StageUnit {
    /// No unit: one run of a tool.
    Uncounted,
    /// Steps, with a name.
    Steps,
    /// Frames, with a note beside the count.
    Frames,
}

/// The count that is done, and the total if it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct StageAmount {
    pub(super) done: u64,
    pub(super) total: Option<u64>,
}

impl StageAmount {
    /// Makes an amount. A total of 0 is unknown. A total is at least `done`, because a damaged
    /// video may promise fewer frames than it has.
    pub(super) fn new(done: u64, all: Option<u64>) -> Self {
        Self { done, total: all.filter(|&all| all > 0).map(|all| all.max(done)) }
    }
}

/// The present stage of a command.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ProgressStage {
    /// The unit of the count; `None` before the command has reported a stage.
    pub(super) unit: Option<StageUnit>,
    pub(super) label: String,
    pub(super) amount: StageAmount,
    /// The time at which the stage began. `first` is the count that was done by then.
    start: Instant,
    count_at_start: u64,
}

/// The time that the rest takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RemainingTime {
    About(Duration),
    MoreThan(Duration),
}

impl ProgressStage {
    pub(super) fn new(now: Instant) -> Self {
        let (amount, what) = (StageAmount::default(), String::new());
        Self { unit: None, label: what, amount, start: now, count_at_start: 0 }
    }

    /// Enters the next stage, or updates the present one. Steps with another name begin a stage
    /// with a rate of its own; the notes of frames change within a stage.
    pub(super) fn enter(
        &mut self,
        counted: StageUnit,
        what: &str,
        amount: StageAmount,
        now: Instant,
    ) {
        let same = self.unit == Some(counted)
            && self.amount.total.is_some() == amount.total.is_some()
            && (counted != StageUnit::Steps || self.label == what);
        if !same || amount.done < self.count_at_start {
            (self.start, self.count_at_start) = (now, amount.done);
        }
        (self.unit, self.amount) = (Some(counted), amount);
        what.clone_into(&mut self.label);
    }

    /// Returns the count since the stage began, and the time that it took; `None` until they give a
    /// rate.
    fn pace(&self, now: Instant) -> Option<(u64, Duration)> {
        let elapsed = now.saturating_duration_since(self.start);
        let fresh = self.amount.done.saturating_sub(self.count_at_start);
        (fresh > 0 && elapsed >= PACE_AFTER).then_some((fresh, elapsed))
    }

    /// Returns the count per second since the stage began.
    pub(super) fn rate(&self, now: Instant) -> Option<f64> {
        let (fresh, elapsed) = self.pace(now)?;
        #[allow(clippy::cast_precision_loss, reason = "three digits of it are told")]
        Some(fresh as f64 / elapsed.as_secs_f64())
    }

    /// Returns the time that the rest takes at the rate since the stage began; `None` until
    /// something is done, and when nothing is left. During a long step the result grows little by
    /// little.
    pub(super) fn remaining_time(&self, now: Instant) -> Option<RemainingTime> {
        let (fresh, elapsed) = self.pace(now)?;
        let rest = self.amount.total?.saturating_sub(self.amount.done);
        if rest == 0 {
            return None;
        }
        let millis = elapsed.as_millis() * u128::from(rest) / u128::from(fresh);
        Some(match u64::try_from(millis).map(Duration::from_millis) {
            Ok(left) if left <= LONGEST_REMAINING => RemainingTime::About(left),
            _ => RemainingTime::MoreThan(LONGEST_REMAINING),
        })
    }
}

/// Locks the stage. Its value is valid even if a thread panicked while it held the lock.
pub(super) fn lock_stage(stage: &Mutex<ProgressStage>) -> MutexGuard<'_, ProgressStage> {
    stage.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::StageUnit::{Frames, Steps};
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn amount(done: u64, all: u64) -> StageAmount {
        StageAmount::new(done, Some(all))
    }

    #[test]
    fn the_rest_takes_as_long_as_what_is_done() {
        let start = Instant::now();
        let left = |done, seconds: u32| {
            let mut stage = ProgressStage::new(start);
            stage.enter(Steps, "designs", amount(0, 31), start);
            stage.enter(Steps, "designs", amount(done, 31), start + seconds * SECOND);
            stage.remaining_time(start + seconds * SECOND)
        };
        assert_eq!(left(0, 100), None, "nothing is done");
        assert_eq!(left(10, 1), None, "too early");
        assert_eq!(left(31, 100), None, "nothing is left");
        assert_eq!(left(10, 100), Some(RemainingTime::About(210 * SECOND)));
        // After ten minutes without a step, and after a day, the time has grown only in proportion.
        assert_eq!(left(10, 700), Some(RemainingTime::About(1470 * SECOND)));
        assert_eq!(left(10, 86_500), Some(RemainingTime::About(181_650 * SECOND)));
    }

    #[test]
    fn no_time_is_longer_than_a_week() {
        let start = Instant::now();
        let mut stage = ProgressStage::new(start);
        stage.enter(Frames, "", amount(0, u64::MAX), start);
        stage.enter(Frames, "", amount(1, u64::MAX), start);
        assert_eq!(
            stage.remaining_time(start + 60 * SECOND),
            Some(RemainingTime::MoreThan(LONGEST_REMAINING))
        );
    }

    #[test]
    fn other_steps_have_a_pace_of_their_own_and_other_notes_have_not() {
        let start = Instant::now();
        let mut stage = ProgressStage::new(start);
        stage.enter(Steps, "fast", amount(0, 100), start);
        stage.enter(Steps, "fast", amount(90, 100), start + 10 * SECOND);
        let then = start + 100 * SECOND;
        stage.enter(Steps, "slow", amount(4, 10), then);
        assert_eq!(stage.remaining_time(then + 50 * SECOND), None);
        stage.enter(Steps, "slow", amount(5, 10), then + 50 * SECOND);
        assert_eq!(
            stage.remaining_time(then + 50 * SECOND),
            Some(RemainingTime::About(250 * SECOND))
        );
        stage.enter(Frames, "1/2 clips", amount(0, 60), then);
        stage.enter(Frames, "2/2 clips", amount(50, 60), then + 50 * SECOND);
        assert_eq!(
            stage.remaining_time(then + 50 * SECOND),
            Some(RemainingTime::About(10 * SECOND))
        );
    }

    #[test]
    fn a_rate_is_what_was_done_in_the_time_that_it_took() {
        let start = Instant::now();
        let mut stage = ProgressStage::new(start);
        // A count from before the stage is left out, and a length that becomes known begins a new
        // stage.
        stage.enter(Frames, "", StageAmount::new(100, None), start);
        stage.enter(Frames, "", StageAmount::new(149, None), start + 5 * SECOND);
        assert_eq!(stage.rate(start + 5 * SECOND), Some(9.8));
        assert_eq!(stage.rate(start + SECOND), None, "too early");
        assert_eq!(stage.remaining_time(start + 5 * SECOND), None, "the length is not known");
        stage.enter(Frames, "", amount(150, 200), start + 6 * SECOND);
        assert_eq!(stage.rate(start + 9 * SECOND), None, "nothing is done since");
    }

    #[test]
    fn nothing_has_no_length() {
        assert_eq!(StageAmount::new(0, Some(0)), StageAmount::new(0, None));
        assert_eq!(StageAmount::new(5, Some(3)), amount(5, 5));
    }
}
