// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clock that a netlist is expected to reach, where no open program can place it: its slowest path by
//! the delays of Yosys' cell models, with a stated share of wires. `docs/clock.md` has how far the same
//! estimate is from what nextpnr reaches on ECP5, and what that says about other devices.

use serde::{Deserialize, Serialize};

use crate::error::EstimateError;
use crate::levels::{Library, LogicPath, WIRING_SHARE, slowest_path};

/// By how much an estimate may be off, as a part of what is reached. In the calibration it was off by less
/// than half as much; its designs are small, and wires are longer in a full device.
const ERROR: f64 = 0.25;

/// An estimated clock with its range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClockEstimate {
    /// The estimate in MHz.
    pub mhz: f64,
    /// What is reached if the estimate is 25 % too high.
    pub low_mhz: f64,
    /// What is reached if it is 25 % too low.
    pub high_mhz: f64,
    /// The part of the time that is wires.
    pub wiring_share: f64,
    /// The path that needs the most time, which need not be the one of the most levels.
    pub path: LogicPath,
}

impl ClockEstimate {
    /// Of a module with all that is inside it; nothing where it has no path with a delay.
    pub(crate) fn of(
        file: &'static str,
        json: &[u8],
        top: &str,
        library: Library,
    ) -> Result<Option<Self>, EstimateError> {
        let (path, ps) = slowest_path(file, json, top, library)?;
        let mhz = 1e6 / f64::from(ps);
        Ok((ps > 0).then(|| Self {
            mhz,
            low_mhz: mhz / (1.0 + ERROR),
            high_mhz: mhz / (1.0 - ERROR),
            wiring_share: WIRING_SHARE,
            path,
        }))
    }

    /// `61 MHz (49 to 81)`.
    #[must_use]
    pub fn text(&self) -> String {
        format!("{:.0} MHz ({:.0} to {:.0})", self.mhz, self.low_mhz, self.high_mhz)
    }
}
