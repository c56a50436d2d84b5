// SPDX-License-Identifier: MIT OR Apache-2.0
//! The speed of a design: its frames per second ([`FrameRate`]) at a given clock, or at the
//! clock that its netlist is expected to reach where no open program can place it
//! ([`ClockEstimate`]).
//!
//! The estimate follows from the slowest path by the delays of Yosys' cell models, with a fixed
//! share for wires. `docs/clock.md` states how far the same estimate is from the results of
//! nextpnr on ECP5, and what that means for other devices.

use crate::error::EstimateError;
use crate::logic_levels::{CellLibrary, LogicPath, WIRING_SHARE, slowest_path};
use foveate_output::number_text::real_number;
use serde::{Deserialize, Serialize};

/// A clock and the frames per second at it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FrameRate {
    /// The clock in MHz.
    pub clock_mhz: f64,
    /// The low end of the range of the clock in MHz; the clock itself if it was given.
    pub low_clock_mhz: f64,
    /// The high end of the range of the clock in MHz; the clock itself if it was given.
    pub high_clock_mhz: f64,
    /// True if the clock is estimated, as opposed to given.
    pub estimated: bool,
    /// Frames per second at the clock.
    pub frames_per_second: f64,
    /// Frames per second at the low end of the clock's range.
    pub low_frames_per_second: f64,
    /// Frames per second at the high end of the clock's range.
    pub high_frames_per_second: f64,
}

impl FrameRate {
    /// Computes the frames per second at a given clock.
    #[must_use]
    pub fn at_given_clock(mhz: f64, clocks_per_frame: u64) -> Self {
        Self::from_clocks([mhz; 3], false, clocks_per_frame)
    }

    /// Computes the frames per second at the estimated clock.
    #[must_use]
    pub fn at_estimated_clock(clock: &ClockEstimate, clocks_per_frame: u64) -> Self {
        Self::from_clocks([clock.low_mhz, clock.mhz, clock.high_mhz], true, clocks_per_frame)
    }

    fn from_clocks([low, clock, high]: [f64; 3], estimated: bool, clocks_per_frame: u64) -> Self {
        let [low_rate, rate, high_rate] =
            [low, clock, high].map(|mhz| mhz * 1e6 / count_to_f64(clocks_per_frame.max(1)));
        Self {
            clock_mhz: clock,
            low_clock_mhz: low,
            high_clock_mhz: high,
            estimated,
            frames_per_second: rate,
            low_frames_per_second: low_rate,
            high_frames_per_second: high_rate,
        }
    }

    /// Returns the clock in MHz as text: `44 (35 to 59)` if it is estimated, else as it was given.
    #[must_use]
    pub fn clock_text(&self) -> String {
        let Self { clock_mhz, low_clock_mhz, high_clock_mhz, .. } = self;
        if self.estimated {
            format!("{clock_mhz:.0} ({low_clock_mhz:.0} to {high_clock_mhz:.0})")
        } else {
            clock_mhz.to_string()
        }
    }

    /// Returns the frames per second as text: `685,714` from a thousand on, else with a digit after
    /// the point.
    #[must_use]
    pub fn rate_text(&self) -> String {
        real_number(self.frames_per_second, 1)
    }

    /// Returns the frames per second with their range as text: `5.6 (4.5 to 7.4)` if the clock is
    /// estimated.
    #[must_use]
    pub fn rate_with_range(&self) -> String {
        let rate = self.rate_text();
        if !self.estimated {
            return rate;
        }
        let ends = [self.low_frames_per_second, self.high_frames_per_second];
        let [low, high] = ends.map(|rate| real_number(rate, 1));
        format!("{rate} ({low} to {high})")
    }

    /// Returns the rate and the clock as text: `31.6 frames/s at 250 MHz`, or
    /// `5.6 (4.5 to 7.4) frames/s at an estimated clock of 44 (35 to 59) MHz`.
    #[must_use]
    pub fn text(&self) -> String {
        let an_estimated = if self.estimated { "an estimated clock of " } else { "" };
        format!("{} frames/s at {an_estimated}{} MHz", self.rate_with_range(), self.clock_text())
    }
}

/// Returns the most clocks per frame that reach this number of frames per second at a clock in Hz.
#[must_use]
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "positive and below 2^53"
)]
pub fn most_clocks_per_frame(hertz: f64, fps: f64) -> u64 {
    (hertz / fps.max(1e-9)).floor() as u64
}

/// Converts a count to a floating-point number.
#[must_use]
#[allow(clippy::cast_precision_loss, reason = "exact up to 2^53")]
pub fn count_to_f64(clocks: u64) -> f64 {
    clocks as f64
}

/// The largest expected error of an estimate, as a part of the real frequency. In the calibration
/// the error was less than half of this. The designs of the calibration are small, and wires are
/// longer in a full device.
const LARGEST_ERROR: f64 = 0.25;

/// An estimated clock frequency with its range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClockEstimate {
    /// The estimated frequency in MHz.
    pub mhz: f64,
    /// The real frequency in MHz if the estimate is 25 % too high.
    pub low_mhz: f64,
    /// The real frequency in MHz if the estimate is 25 % too low.
    pub high_mhz: f64,
    /// The share of wires in the delay of the path.
    pub wiring_share: f64,
    /// The slowest path, which need not be the one with the most levels.
    pub path: LogicPath,
}

impl ClockEstimate {
    /// Estimates the clock frequency of a module with all modules inside it. Returns `None` if the
    /// module has no path with a delay.
    pub(crate) fn of(
        file: &'static str,
        json: &[u8],
        top: &str,
        library: CellLibrary,
    ) -> Result<Option<Self>, EstimateError> {
        let (path, ps) = slowest_path(file, json, top, library)?;
        let mhz = 1e6 / f64::from(ps);
        Ok((ps > 0).then(|| Self {
            mhz,
            low_mhz: mhz / (1.0 + LARGEST_ERROR),
            high_mhz: mhz / (1.0 - LARGEST_ERROR),
            wiring_share: WIRING_SHARE,
            path,
        }))
    }

    /// Returns the estimate and its range as text, such as `61 MHz (49 to 81)`.
    #[must_use]
    pub fn text(&self) -> String {
        format!("{:.0} MHz ({:.0} to {:.0})", self.mhz, self.low_mhz, self.high_mhz)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logic_levels::LogicPath;

    #[test]
    fn a_rate_stands_beside_the_clock_that_it_holds_at() {
        assert_eq!(FrameRate::at_given_clock(250.0, 64).text(), "3,906,250 frames/s at 250 MHz");
        assert_eq!(FrameRate::at_given_clock(33.5, 2_000_000).text(), "16.8 frames/s at 33.5 MHz");
        let clock = ClockEstimate {
            mhz: 60.0,
            low_mhz: 48.0,
            high_mhz: 80.0,
            wiring_share: 0.65,
            path: LogicPath::default(),
        };
        let speed = FrameRate::at_estimated_clock(&clock, 600_000);
        assert_eq!(
            speed.text(),
            "100.0 (80.0 to 133.3) frames/s at an estimated clock of 60 (48 to 80) MHz"
        );
        assert_eq!((speed.low_frames_per_second, speed.frames_per_second), (80.0, 100.0));
    }
}
