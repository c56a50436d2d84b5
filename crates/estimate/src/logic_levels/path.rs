// SPDX-License-Identifier: MIT OR Apache-2.0
//! The longest path in reports, and the order of paths by length.

use serde::{Deserialize, Serialize};

/// The longest path of a module.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogicPath {
    /// The number of logic levels.
    pub levels: u32,
    /// The number of blocks of four bits that the path crosses in carry chains.
    pub carry4: u32,
    /// The start of the path: an input port, or the output of a register or memory.
    pub from: String,
    /// The end of the path: an output port, or a pin of a register or memory.
    pub to: String,
    /// The types of the cells in between, in order.
    pub through: Vec<String>,
}

/// The share of wires in the delay of a path. It was determined on ECP5, where nextpnr reports the
/// real frequency: see `docs/clock.md`.
pub(crate) const WIRING_SHARE: f64 = 0.65;

/// The levels and carry blocks of a path, and its estimated delay in picoseconds, wires included.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct PathWeight {
    pub(super) levels: u32,
    pub(super) carry4: u32,
    pub(super) ps: u32,
}

impl PathWeight {
    pub(super) const NONE: Self = Self { levels: 0, carry4: 0, ps: 0 };
    pub(super) const LEVEL: Self = Self { levels: 1, carry4: 0, ps: 0 };
    pub(super) const CHAIN: Self = Self { levels: 1, carry4: 1, ps: 0 };
    pub(super) const BLOCK: Self = Self { levels: 0, carry4: 1, ps: 0 };

    /// Makes the weight of a delay in logic, and adds the share of the wires.
    pub(super) fn with_wires(ps: u32) -> Self {
        Self::without_wires(delay_with_wires(ps))
    }

    /// Makes the weight of a delay inside a block, which no wires follow.
    pub(super) fn without_wires(ps: u32) -> Self {
        Self { ps, ..Self::NONE }
    }

    /// Makes the initial weight of a path: the delay of a flip-flop with the usual share of wires,
    /// and the additional delay of a slower block without wires.
    pub(super) fn after_clock(clock_to_output: u32, flip_flop: u32) -> Self {
        Self::with_wires(flip_flop)
            .plus(Self::without_wires(clock_to_output.saturating_sub(flip_flop)))
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            levels: self.levels + other.levels,
            carry4: self.carry4 + other.carry4,
            ps: self.ps + other.ps,
        }
    }

    /// Returns the key that orders paths by levels, and by carry blocks for equal levels.
    pub(super) fn by_levels(self) -> (u32, u32) {
        (self.levels, self.carry4)
    }

    /// Returns the key that orders paths by delay, and by levels for equal delays.
    pub(super) fn by_time(self) -> (u32, u32) {
        (self.ps, self.levels)
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a delay of some nanoseconds, rounded"
)]
fn delay_with_wires(ps: u32) -> u32 {
    (f64::from(ps) / (1.0 - WIRING_SHARE)).round() as u32
}
