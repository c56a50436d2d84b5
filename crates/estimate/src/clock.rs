// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clock frequency that a netlist is expected to reach, where no open program can place it. It
//! follows from the slowest path by the delays of Yosys' cell models, with a fixed share for wires.
//! `docs/clock.md` states how far the same estimate is from the results of nextpnr on ECP5, and
//! what that means for other devices.

use serde::{Deserialize, Serialize};

use crate::error::EstimateError;
use crate::logic_levels::{CellLibrary, LogicPath, WIRING_SHARE, slowest_path};

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
