// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words of a stage: in a log, and on a line of a terminal that may be narrow.

use std::time::{Duration, Instant};

use foveate_media::{ProgressStage, ProgressUnit, RemainingTime, StageAmount};
use indicatif::{HumanCount, HumanDuration};
use textwrap::core::display_width;

/// Returns the state of a command for a log; `None` until the command has reported a stage. `start`
/// is the time at which the command began.
pub(super) fn log_line(stage: &ProgressStage, start: Instant, now: Instant) -> Option<String> {
    let (counted, what) = (stage.unit?, &stage.label);
    let StageAmount { done, total: all } = stage.amount;
    let elapsed = HumanDuration(now.saturating_duration_since(start));
    let rate = stage.rate(now).map(|rate| format!(", {}", rate_text(rate, counted)));
    let left = stage.remaining_time(now).map(|left| match left {
        RemainingTime::About(left) => format!(", about {} left", HumanDuration(left)),
        RemainingTime::MoreThan(left) => format!(", more than {} left", HumanDuration(left)),
    });
    let after = format!("after {elapsed}{}{}", rate.unwrap_or_default(), left.unwrap_or_default());
    let amount = all.map_or(done.to_string(), |all| format!("{done} of {all}"));
    let note = if what.is_empty() { String::new() } else { format!(" ({what})") };
    Some(match counted {
        ProgressUnit::Uncounted => format!("{what}, {elapsed} so far"),
        ProgressUnit::Steps => format!("{what}: {amount} {after}"),
        ProgressUnit::Frames => format!("{amount} frames {after}{note}"),
    })
}

/// Returns the state of a command in at most `columns` columns of a terminal. The count is always
/// shown. The time that is left, the rate, the elapsed time and the note follow as there is room,
/// in this order.
pub(super) fn terminal_line(
    stage: &ProgressStage,
    elapsed: Duration,
    now: Instant,
    columns: usize,
) -> String {
    let Some(counted) = stage.unit else { return String::new() };
    let elapsed = format!("{:#}", HumanDuration(elapsed));
    let rate = stage.rate(now).map(|rate| rate_text(rate, counted));
    let left = stage.remaining_time(now).map(|left| match left {
        RemainingTime::About(left) => format!("{:#} left", HumanDuration(left)),
        RemainingTime::MoreThan(left) => format!("over {:#} left", HumanDuration(left)),
    });
    let StageAmount { done, total: all } = stage.amount;
    let amount = all.map_or(done.to_string(), |all| format!("{done}/{all}"));
    let (before, unit, note) = match counted {
        ProgressUnit::Uncounted => (stage.label.clone(), String::new(), ""),
        ProgressUnit::Steps => (format!("{} {amount}", stage.label), amount.clone(), ""),
        ProgressUnit::Frames => (format!("{amount} frames"), amount.clone(), &*stage.label),
    };
    let details = |parts: &[Option<&String>]| -> String {
        let parts: Vec<&str> = parts.iter().flatten().map(|part| part.as_str()).collect();
        if parts.is_empty() { String::new() } else { format!(" [{}]", parts.join(", ")) }
    };
    let (elapsed, rate, left) = (Some(&elapsed), rate.as_ref(), left.as_ref());
    let least = if unit.is_empty() { &before } else { &unit };
    let whole = details(&[elapsed, rate, left]);
    let lines = [
        format!("{before}{whole} {note}").trim_end().to_owned(),
        format!("{before}{whole}"),
        format!("{before}{}", details(&[rate, left])),
        format!("{before}{}", details(&[left.or(rate)])),
        format!("{least}{}", details(&[left.or(rate)])),
        before.clone(),
    ];
    let fits = |line: &String| display_width(line) <= columns;
    lines.into_iter().find(fits).unwrap_or_else(|| truncated(least, columns))
}

/// Returns the first characters of `text` that fit into `columns`.
fn truncated(text: &str, columns: usize) -> String {
    let mut cut = String::new();
    for character in text.chars() {
        cut.push(character);
        if display_width(&cut) > columns {
            cut.pop();
            break;
        }
    }
    cut
}

/// Returns a rate per second, per minute or per hour: the first of these that is at least 1.
fn rate_text(rate: f64, counted: ProgressUnit) -> String {
    let unit = match counted {
        ProgressUnit::Uncounted | ProgressUnit::Steps => "",
        ProgressUnit::Frames => " frames",
    };
    let (count, time) = match rate {
        rate if rate >= 1.0 => (rate, "s"),
        rate if rate * 60.0 >= 1.0 => (rate * 60.0, "min"),
        rate => (rate * 3600.0, "h"),
    };
    // 9.96 is shown as 10, not as 10.0.
    if count < 9.95 {
        return format!("{count:.1}{unit}/{time}");
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is 10 or more")]
    let count = count.round() as u64;
    format!("{}{unit}/{time}", HumanCount(count))
}

#[cfg(test)]
mod tests {
    use foveate_media::RunProgress;

    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    /// Returns a stage at 66 seconds after its start, when `first` was done.
    fn stage(
        counted: ProgressUnit,
        what: &str,
        first: u64,
        amount: StageAmount,
    ) -> (ProgressStage, Instant) {
        let start = Instant::now();
        let mut stage = ProgressStage::new(start);
        let report = |done| {
            let StageAmount { total, .. } = amount;
            RunProgress { unit: counted, label: what.into(), done, total }
        };
        stage.enter(&report(first), start);
        stage.enter(&report(amount.done), start + 66 * SECOND);
        (stage, start)
    }

    fn amount(done: u64, all: u64) -> StageAmount {
        StageAmount::new(done, Some(all))
    }

    #[test]
    fn lines_of_a_log_say_what_goes_on() {
        let told = |counted, what: &str, first, amount| {
            let (stage, start) = stage(counted, what, first, amount);
            log_line(&stage, start, start + 66 * SECOND).unwrap()
        };
        let work = told(ProgressUnit::Uncounted, "compiling", 0, StageAmount::default());
        assert_eq!(work, "compiling, 66 seconds so far");
        let none = told(ProgressUnit::Steps, "designs", 12, amount(12, 40));
        assert_eq!(none, "designs: 12 of 40 after 66 seconds");
        let some = told(ProgressUnit::Steps, "designs", 0, amount(12, 40));
        assert_eq!(some, "designs: 12 of 40 after 66 seconds, 11/min, about 3 minutes left");
        assert_eq!(
            told(ProgressUnit::Frames, "1/2 clips", 6, amount(12, 40)),
            "12 of 40 frames after 66 seconds, 5.5 frames/min, about 5 minutes left (1/2 clips)"
        );
        assert_eq!(
            told(ProgressUnit::Frames, "1/2 clips", 0, StageAmount::new(647, None)),
            "647 frames after 66 seconds, 9.8 frames/s (1/2 clips)"
        );
        assert_eq!(told(ProgressUnit::Frames, "", 0, amount(0, 0)), "0 frames after 66 seconds");
        let most = told(ProgressUnit::Steps, "designs", 0, amount(12, u64::MAX));
        assert!(most.ends_with("after 66 seconds, 11/min, more than 7 days left"), "{most}");
        let start = Instant::now();
        assert_eq!(log_line(&ProgressStage::new(start), start, start), None);
    }

    #[test]
    fn a_line_of_a_terminal_says_as_much_as_it_has_room_for() {
        let told = |counted, what: &str, amount, columns| {
            let (stage, start) = stage(counted, what, 0, amount);
            terminal_line(&stage, 66 * SECOND, start + 66 * SECOND, columns)
        };
        let frames = |columns| told(ProgressUnit::Frames, "1/2 clips", amount(647, 1000), columns);
        assert_eq!(frames(80), "647/1000 frames [66s, 9.8 frames/s, 36s left] 1/2 clips");
        assert_eq!(frames(54), "647/1000 frames [66s, 9.8 frames/s, 36s left]");
        assert_eq!(frames(44), "647/1000 frames [9.8 frames/s, 36s left]");
        assert_eq!(frames(30), "647/1000 frames [36s left]");
        assert_eq!(frames(20), "647/1000 [36s left]");
        assert_eq!(frames(15), "647/1000 frames");
        assert_eq!(frames(10), "647/1000");
        assert_eq!(frames(5), "647/1");
        assert_eq!(frames(0), "");
        let stream = |columns| told(ProgressUnit::Frames, "", StageAmount::new(647, None), columns);
        assert_eq!(stream(40), "647 frames [66s, 9.8 frames/s]");
        assert_eq!(stream(20), "647 [9.8 frames/s]");
        let steps = |columns| told(ProgressUnit::Steps, "synthesizing", amount(12, 40), columns);
        assert_eq!(steps(80), "synthesizing 12/40 [66s, 11/min, 3m left]");
        assert_eq!(steps(20), "12/40 [3m left]");
        let work = |columns| {
            told(ProgressUnit::Uncounted, "placing and routing", StageAmount::default(), columns)
        };
        assert_eq!((&*work(40), &*work(19)), ("placing and routing [66s]", "placing and routing"));
        assert_eq!(work(7), "placing");
        assert_eq!(told(ProgressUnit::Frames, "", amount(0, 0), 40), "0 frames [66s]");
        assert_eq!(
            told(ProgressUnit::Frames, "", amount(1, 1), 40),
            "1/1 frames [66s, 55 frames/h]"
        );
    }

    #[test]
    fn a_rate_has_the_digits_that_say_something() {
        for (rate, told) in [
            (9.793, "9.8 frames/s"),
            (9.96, "10 frames/s"),
            (1.0, "1.0 frames/s"),
            (0.9, "54 frames/min"),
            (0.05, "3.0 frames/min"),
            (0.001, "3.6 frames/h"),
            (27.5391, "28 frames/s"),
            (1234.5, "1,235 frames/s"),
            (0.0, "0.0 frames/h"),
        ] {
            assert_eq!(rate_text(rate, ProgressUnit::Frames), told);
        }
        assert_eq!(rate_text(2.0, ProgressUnit::Steps), "2.0/s");
        assert_eq!(rate_text(f64::INFINITY, ProgressUnit::Steps), "18,446,744,073,709,551,615/s");
    }
}
