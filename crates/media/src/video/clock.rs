// SPDX-License-Identifier: MIT OR Apache-2.0
//! The times of the frames of a video ([`VideoClock`]). A container may hold times that go back,
//! as joined recordings do. The clock then goes on from the time before by the last step.

use crate::FrameRate;

/// The clock of a video. All times are in microseconds since the first frame.
#[derive(Debug)]
pub(super) struct VideoClock {
    /// The amount by which times are later than those of the container.
    delay_us: i128,
    last_us: Option<u64>,
    step_us: u64,
    backward_steps: u64,
    first_backward_step: Option<BackwardStep>,
}

/// A time that goes back.
#[derive(Debug)]
struct BackwardStep {
    /// The number of the frame, counted from 0.
    frame: u64,
    /// The time of the frame before.
    before_us: u64,
    /// The time of the frame in the container.
    stated_us: i128,
}

impl VideoClock {
    /// Returns the clock of a video whose first step, if it is not known, is that of a rate.
    pub(super) fn new(rate: FrameRate) -> Self {
        Self {
            delay_us: 0,
            last_us: None,
            step_us: rate.time_us(1),
            backward_steps: 0,
            first_backward_step: None,
        }
    }

    /// Returns the time of the next frame, whose time in the container is `stated_us`. `frame` is
    /// its number.
    pub(super) fn time_us(&mut self, frame: u64, stated_us: i128) -> u64 {
        let last_us = self.last_us.unwrap_or(0);
        let mut time_us = stated_us + self.delay_us;
        if time_us < i128::from(last_us) {
            self.backward_steps += 1;
            self.first_backward_step.get_or_insert(BackwardStep {
                frame,
                before_us: last_us,
                stated_us,
            });
            time_us = i128::from(last_us) + i128::from(self.step_us);
            self.delay_us = time_us - stated_us;
        }
        let time_us = u64::try_from(time_us).unwrap_or(u64::MAX);
        if self.last_us.is_some() && time_us > last_us {
            self.step_us = time_us - last_us;
        }
        self.last_us = Some(time_us);
        time_us
    }

    /// Returns a warning if times went back.
    pub(super) fn warning(&self, name: &str) -> Option<String> {
        let first = self.first_backward_step.as_ref()?;
        let times = match self.backward_steps {
            1 => "once".to_owned(),
            times => format!("{times} times"),
        };
        let seconds = |us: i128| {
            let (sign, us) = (if us < 0 { "-" } else { "" }, us.unsigned_abs());
            format!("{sign}{}.{:06} s", us / 1_000_000, us % 1_000_000)
        };
        Some(format!(
            "the times of `{name}` go back {times}, first at frame {}: from {} to {}; the clock goes on \
             from there by the last step",
            first.frame,
            seconds(first.before_us.into()),
            seconds(first.stated_us)
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(stated: &[i128]) -> (Vec<u64>, Option<String>) {
        let mut clock = VideoClock::new(FrameRate::parse("25").unwrap());
        let times = (0..).zip(stated).map(|(frame, &us)| clock.time_us(frame, us)).collect();
        (times, clock.warning("a.mkv"))
    }

    #[test]
    fn times_that_do_not_go_back_stay() {
        assert_eq!(times(&[0, 40, 40, 100]), (vec![0, 40, 40, 100], None));
    }

    #[test]
    fn a_clock_that_goes_back_goes_on_by_the_last_step() {
        let (seen, warning) = times(&[0, 40, 100, 0, 40, 100, 30]);
        assert_eq!(seen, [0, 40, 100, 160, 200, 260, 320]);
        let warning = warning.unwrap();
        assert!(
            warning.contains("2 times, first at frame 3: from 0.000100 s to 0.000000 s"),
            "{warning}"
        );
        // Before there is a step, the rate has one; the first frame is at 0.
        assert_eq!(times(&[0, -5, 35]).0, [0, 40_000, 40_040]);
        assert!(times(&[0, -5]).1.unwrap().contains("once, first at frame 1"));
        assert!(times(&[0, -5]).1.unwrap().contains("to -0.000005 s"));
    }
}
