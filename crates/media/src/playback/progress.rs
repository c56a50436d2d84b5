// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run tells its caller, and the caller to the run ([`RunHooks`]): its progress
//! ([`RunProgress`]), and the wish to end it. A [`ProgressStage`] adds the rate and the time
//! that is left.

use foveate_tools::Interrupt;
use std::borrow::Cow;
use std::time::{Duration, Instant};

/// The time after which a rate is computed. Before, results may come from a cache, or a tool may
/// start.
const PACE_AFTER: Duration = Duration::from_secs(2);
/// The longest time that is shown as it is. A longer time is shown as more than this, because no
/// meaningful run takes so long.
const LONGEST_REMAINING: Duration = Duration::from_secs(7 * 24 * 3600);

/// The unit in which a stage counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgressUnit {
    /// No unit: one run of a tool.
    Uncounted,
    /// Steps, with a name.
    Steps,
    /// Frames, with a note beside the count.
    Frames,
}

/// A report of progress.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunProgress<'a> {
    /// The unit of the count.
    pub unit: ProgressUnit,
    /// The name of the work or of its steps, or the note beside a count of frames.
    pub label: Cow<'a, str>,
    /// The count that is done.
    pub done: u64,
    /// The count of all, if it is known.
    pub total: Option<u64>,
}

impl<'a> RunProgress<'a> {
    /// Reports work of unknown length, such as one run of a tool: `synthesizing with Yosys`.
    #[must_use]
    pub fn work(label: impl Into<Cow<'a, str>>) -> Self {
        Self { unit: ProgressUnit::Uncounted, label: label.into(), done: 0, total: None }
    }

    /// Reports that `done` of `all` steps are done, such as `designs over clips`. If there are no
    /// steps, this is the same as [`RunProgress::work`].
    #[must_use]
    pub fn steps(label: impl Into<Cow<'a, str>>, done: u64, all: u64) -> Self {
        if all == 0 {
            return Self::work(label);
        }
        Self { unit: ProgressUnit::Steps, label: label.into(), done, total: Some(all) }
    }

    /// Reports that `done` frames are done, of `total` if it is known. `note` is shown beside the
    /// count.
    #[must_use]
    pub fn frames(done: u64, total: Option<u64>, note: impl Into<Cow<'a, str>>) -> Self {
        Self { unit: ProgressUnit::Frames, label: note.into(), done, total }
    }
}

/// The count that is done, and the total if it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageAmount {
    /// The count that is done.
    pub done: u64,
    /// The count of all, if it is known.
    pub total: Option<u64>,
}

impl StageAmount {
    /// Makes an amount. A total of 0 is unknown. A total is at least `done`, because a damaged
    /// video may promise fewer frames than it has.
    #[must_use]
    pub fn new(done: u64, total: Option<u64>) -> Self {
        Self { done, total: total.filter(|&total| total > 0).map(|total| total.max(done)) }
    }
}

/// The present stage of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgressStage {
    /// The unit of the count; `None` before the run has reported a stage.
    pub unit: Option<ProgressUnit>,
    /// The name of the work or of its steps, or the note beside a count of frames.
    pub label: String,
    /// The count that is done, and that of all.
    pub amount: StageAmount,
    /// The time at which the stage began.
    start: Instant,
    /// The count that was done when the stage began.
    count_at_start: u64,
}

/// The time that the rest takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RemainingTime {
    /// The time at the present rate.
    About(Duration),
    /// A time that the rest exceeds.
    MoreThan(Duration),
}

impl ProgressStage {
    /// Makes the state of a run that has reported no stage.
    #[must_use]
    pub fn new(now: Instant) -> Self {
        let (amount, what) = (StageAmount::default(), String::new());
        Self { unit: None, label: what, amount, start: now, count_at_start: 0 }
    }

    /// Enters the next stage, or updates the present one. Steps with another name begin a stage
    /// with a rate of its own; the notes of frames change within a stage.
    pub fn enter(&mut self, progress: &RunProgress<'_>, now: Instant) {
        let amount = StageAmount::new(progress.done, progress.total);
        let same = self.unit == Some(progress.unit)
            && self.amount.total.is_some() == amount.total.is_some()
            && (progress.unit != ProgressUnit::Steps || self.label == progress.label);
        if !same || amount.done < self.count_at_start {
            (self.start, self.count_at_start) = (now, amount.done);
        }
        (self.unit, self.amount) = (Some(progress.unit), amount);
        self.label.clear();
        self.label.push_str(&progress.label);
    }

    /// Returns the count since the stage began, and the time that it took; `None` until they give a
    /// rate.
    fn pace(&self, now: Instant) -> Option<(u64, Duration)> {
        let elapsed = now.saturating_duration_since(self.start);
        let fresh = self.amount.done.saturating_sub(self.count_at_start);
        (fresh > 0 && elapsed >= PACE_AFTER).then_some((fresh, elapsed))
    }

    /// Returns the count per second since the stage began.
    #[must_use]
    pub fn rate(&self, now: Instant) -> Option<f64> {
        let (fresh, elapsed) = self.pace(now)?;
        #[allow(clippy::cast_precision_loss, reason = "three digits of it are told")]
        Some(fresh as f64 / elapsed.as_secs_f64())
    }

    /// Returns the time that the rest takes at the rate since the stage began; `None` until
    /// something is done, and when nothing is left. During a long step the result grows little by
    /// little.
    #[must_use]
    pub fn remaining_time(&self, now: Instant) -> Option<RemainingTime> {
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

/// The callbacks of a run. Several threads call them.
pub trait RunHooks: Sync {
    /// Reports that another frame or step is done.
    fn progress(&self, progress: &RunProgress<'_>);

    /// Returns true if the run is to stop. Each run says which of its results are kept then.
    fn is_cancelled(&self) -> bool;

    /// Returns the request to stop in a form that also ends waits. Hooks without one cannot end a
    /// wait.
    fn interrupt(&self) -> Interrupt {
        Interrupt::default()
    }
}

/// Hooks that report nothing and never stop.
#[derive(Clone, Copy, Debug, Default)]
pub struct SilentHooks;

impl RunHooks for SilentHooks {
    fn progress(&self, _progress: &RunProgress<'_>) {}

    fn is_cancelled(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
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
            stage.enter(&RunProgress::steps("designs", 0, 31), start);
            stage.enter(&RunProgress::steps("designs", done, 31), start + seconds * SECOND);
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
        stage.enter(&RunProgress::frames(0, Some(u64::MAX), ""), start);
        stage.enter(&RunProgress::frames(1, Some(u64::MAX), ""), start);
        assert_eq!(
            stage.remaining_time(start + 60 * SECOND),
            Some(RemainingTime::MoreThan(LONGEST_REMAINING))
        );
    }

    #[test]
    fn other_steps_have_a_pace_of_their_own_and_other_notes_have_not() {
        let start = Instant::now();
        let mut stage = ProgressStage::new(start);
        stage.enter(&RunProgress::steps("fast", 0, 100), start);
        stage.enter(&RunProgress::steps("fast", 90, 100), start + 10 * SECOND);
        let then = start + 100 * SECOND;
        stage.enter(&RunProgress::steps("slow", 4, 10), then);
        assert_eq!(stage.remaining_time(then + 50 * SECOND), None);
        stage.enter(&RunProgress::steps("slow", 5, 10), then + 50 * SECOND);
        assert_eq!(
            stage.remaining_time(then + 50 * SECOND),
            Some(RemainingTime::About(250 * SECOND))
        );
        stage.enter(&RunProgress::frames(0, Some(60), "1/2 clips"), then);
        stage.enter(&RunProgress::frames(50, Some(60), "2/2 clips"), then + 50 * SECOND);
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
        stage.enter(&RunProgress::frames(100, None, ""), start);
        stage.enter(&RunProgress::frames(149, None, ""), start + 5 * SECOND);
        assert_eq!(stage.rate(start + 5 * SECOND), Some(9.8));
        assert_eq!(stage.rate(start + SECOND), None, "too early");
        assert_eq!(stage.remaining_time(start + 5 * SECOND), None, "the length is not known");
        stage.enter(&RunProgress::frames(150, Some(200), ""), start + 6 * SECOND);
        assert_eq!(stage.rate(start + 9 * SECOND), None, "nothing is done since");
    }

    #[test]
    fn nothing_has_no_length() {
        assert_eq!(StageAmount::new(0, Some(0)), StageAmount::new(0, None));
        assert_eq!(StageAmount::new(5, Some(3)), amount(5, 5));
    }
}
