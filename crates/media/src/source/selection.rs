// SPDX-License-Identifier: MIT OR Apache-2.0
//! The selection of frames of a clip by their times. No frame is repeated or blended.
//!
//! * `start` and `end` select frames with start <= t < end.
//! * `rate` selects at most that many frames per second. Due times are 0, 1/F, 2/F and so on. The
//!   first frame at or after a due time is selected, and the next due time is the first one after
//!   it. A frame that is early by 1 ms, or by an eighth of 1/F if that is less, counts as due,
//!   because containers round their times.

use crate::{FootageError, FrameRate};

/// The largest amount in microseconds by which a due frame may be early. Matroska rounds times to 1
/// ms.
const MAX_EARLY_US: u64 = 1000;

/// The selection of frames of a clip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameSelection {
    /// Frames before this time, in microseconds, are left out.
    pub start_us: Option<u64>,
    /// Frames at this time or later, in microseconds, are left out.
    pub end_us: Option<u64>,
    /// At most this many frames per second are selected.
    pub rate: Option<FrameRate>,
}

/// The decision about a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SelectionDecision {
    Take,
    Skip,
    /// This frame and all later ones are left out.
    End,
}

/// A selection and its state.
#[derive(Debug)]
pub(crate) struct FrameSelector {
    selection: FrameSelection,
    /// The number of the next due time.
    next_due: u128,
}

impl FrameSelector {
    pub(crate) fn new(selection: FrameSelection) -> Self {
        Self { selection, next_due: 0 }
    }

    pub(crate) fn decide(&mut self, time_us: u64) -> SelectionDecision {
        if self.selection.end_us.is_some_and(|end| time_us >= end) {
            return SelectionDecision::End;
        }
        if self.selection.start_us.is_some_and(|start| time_us < start) {
            return SelectionDecision::Skip;
        }
        let Some(rate) = self.selection.rate else { return SelectionDecision::Take };
        let passed = rate.frames_passed(time_us.saturating_add(rate.eighth_us().min(MAX_EARLY_US)));
        if passed < self.next_due {
            return SelectionDecision::Skip;
        }
        self.next_due = passed + 1;
        SelectionDecision::Take
    }
}

impl FrameSelection {
    /// Returns true if every frame is selected.
    pub(crate) fn is_all(&self) -> bool {
        *self == Self::default()
    }

    pub(crate) fn check(&self) -> Result<(), FootageError> {
        match (self.start_us, self.end_us) {
            (start, Some(end)) if start.unwrap_or(0) >= end => Err(FootageError::Option {
                option: "--end",
                problem: "the end must be later than the start".to_owned(),
            }),
            _ => Ok(()),
        }
    }
}

/// Parses a time as seconds (`12`, `12.5`), or as `HH:MM:SS` or `MM:SS` with decimals. Returns
/// microseconds.
///
/// # Errors
/// Fails if the text is not such a time. The error says what is expected.
pub fn parse_time(text: &str) -> Result<u64, String> {
    let wrong = || "expected seconds, such as 12.5, or HH:MM:SS, such as 00:01:02.5".to_owned();
    let (whole, decimals) = text.split_once('.').unwrap_or((text, "0"));
    let number = |digits: &str| {
        let plain = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
        plain.then(|| digits.parse::<u64>().ok()).flatten()
    };
    let parts: Option<Vec<u64>> = whole.split(':').map(number).collect();
    let parts = parts.filter(|parts| parts.len() <= 3).ok_or_else(wrong)?;
    // Minutes and seconds after a larger unit are below 60.
    if parts.iter().skip(1).any(|&part| part >= 60) || number(decimals).is_none() {
        return Err(wrong());
    }
    let seconds = parts.iter().try_fold(0u64, |sum, &part| sum.checked_mul(60)?.checked_add(part));
    let micros = format!("{decimals:0<6}").get(..6).and_then(number).ok_or_else(wrong)?;
    seconds
        .and_then(|seconds| seconds.checked_mul(1_000_000)?.checked_add(micros))
        .ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(rate: (u32, u32), times: impl Iterator<Item = u64>) -> Vec<u64> {
        let rate = Some(FrameRate::new(rate.0, rate.1).unwrap());
        let mut selector = FrameSelector::new(FrameSelection { rate, ..FrameSelection::default() });
        times.filter(|&time| selector.decide(time) == SelectionDecision::Take).collect()
    }

    #[test]
    fn a_rate_takes_the_first_frame_that_is_due() {
        let at = |rate: u32| (0..300).map(move |t| FrameRate::new(rate, 1).unwrap().time_us(t));
        assert_eq!(taken((30, 1), at(30)).len(), 300, "its own rate takes all");
        assert_eq!(taken((60, 1), at(30)).len(), 300, "nothing is repeated");
        assert_eq!(taken((15, 1), at(30)), at(30).step_by(2).collect::<Vec<_>>());
        assert_eq!(taken((1, 2), at(30)), [0, 2_000_000, 4_000_000, 6_000_000, 8_000_000]);
        assert_eq!(taken((10, 1), at(25))[..4], [0, 120_000, 200_000, 320_000]);
        // Matroska rounds to milliseconds.
        let rounded = (0..300u64).map(|t| (t * 1000 + 15) / 30 * 1000);
        assert_eq!(taken((30, 1), rounded).len(), 300);
        // After a gap, no frames are added.
        assert_eq!(taken((10, 1), [0, 900_000, 950_000, 1_000_000].into_iter()).len(), 3);
    }

    #[test]
    fn start_is_in_and_end_is_out() {
        let selection =
            FrameSelection { start_us: Some(20), end_us: Some(40), ..FrameSelection::default() };
        let mut selector = FrameSelector::new(selection);
        let verdicts = [19, 20, 39, 40].map(|time| selector.decide(time));
        assert_eq!(
            verdicts,
            [
                SelectionDecision::Skip,
                SelectionDecision::Take,
                SelectionDecision::Take,
                SelectionDecision::End
            ]
        );
        assert!(selection.check().is_ok());
        assert!(FrameSelection { end_us: Some(20), ..selection }.check().is_err());
    }

    #[test]
    fn times_are_seconds_or_clock_times() {
        for (text, micros) in [
            ("0", 0),
            ("12.5", 12_500_000),
            ("90", 90_000_000),
            ("1:02", 62_000_000),
            ("01:00:00.000001", 3_600_000_001),
            ("0.1234567", 123_456),
        ] {
            assert_eq!(parse_time(text), Ok(micros), "{text}");
        }
        for text in
            ["", "-1", "1:60", "1:2:3:4", "a", "1.", ".5", "1.x", "99999999999999999999", "+1"]
        {
            assert!(parse_time(text).is_err(), "{text}");
        }
    }
}
