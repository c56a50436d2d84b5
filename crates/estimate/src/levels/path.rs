// SPDX-License-Identifier: MIT OR Apache-2.0
//! The longest path as it is reported, and what tells which of two is longer.

use serde::{Deserialize, Serialize};

/// The longest path of a module.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogicPath {
    /// Logic levels.
    pub levels: u32,
    /// Blocks of four bits that it crosses in carry chains.
    pub carry4: u32,
    /// Where it starts: an input port, or the output of a register or memory.
    pub from: String,
    /// Where it ends: an output port, or a pin of a register or memory.
    pub to: String,
    /// The types of the cells between, in order.
    pub through: Vec<String>,
}

/// The part of a path's time that is wires. Found on ECP5, where nextpnr says what is
/// reached: see `docs/clock.md`.
pub(crate) const WIRING_SHARE: f64 = 0.65;

/// What a path has passed, and the time that it is taken to need, wires included.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Weight {
    pub(super) levels: u32,
    pub(super) carry4: u32,
    pub(super) ps: u32,
}

impl Weight {
    pub(super) const NONE: Self = Self { levels: 0, carry4: 0, ps: 0 };
    pub(super) const LEVEL: Self = Self { levels: 1, carry4: 0, ps: 0 };
    pub(super) const CHAIN: Self = Self { levels: 1, carry4: 1, ps: 0 };
    pub(super) const BLOCK: Self = Self { levels: 0, carry4: 1, ps: 0 };

    /// A delay in logic, which has its share of wires beside it.
    pub(super) fn wired(ps: u32) -> Self {
        Self::fixed(with_wires(ps))
    }

    /// A delay inside a block, which wires do not follow.
    pub(super) fn fixed(ps: u32) -> Self {
        Self { ps, ..Self::NONE }
    }

    /// What a path starts with: a flip-flop's delay, with wires as all logic has them, and what a slower
    /// block takes longer.
    pub(super) fn after_clock(clock_to_output: u32, flip_flop: u32) -> Self {
        Self::wired(flip_flop).plus(Self::fixed(clock_to_output.saturating_sub(flip_flop)))
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            levels: self.levels + other.levels,
            carry4: self.carry4 + other.carry4,
            ps: self.ps + other.ps,
        }
    }

    /// Of two paths with equal levels the one with more carry blocks is longer.
    pub(super) fn by_levels(self) -> (u32, u32) {
        (self.levels, self.carry4)
    }

    /// Of two paths that need the same time the one with more levels is longer.
    pub(super) fn by_time(self) -> (u32, u32) {
        (self.ps, self.levels)
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a delay of some nanoseconds, rounded"
)]
fn with_wires(ps: u32) -> u32 {
    (f64::from(ps) / (1.0 - WIRING_SHARE)).round() as u32
}
