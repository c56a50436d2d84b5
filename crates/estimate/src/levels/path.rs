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

/// What a path has passed; of two paths with equal levels the one with more carry blocks is longer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Weight {
    pub(super) levels: u32,
    pub(super) carry4: u32,
}

impl Weight {
    pub(super) const NONE: Self = Self { levels: 0, carry4: 0 };
    pub(super) const LEVEL: Self = Self { levels: 1, carry4: 0 };
    pub(super) const CHAIN: Self = Self { levels: 1, carry4: 1 };
    pub(super) const BLOCK: Self = Self { levels: 0, carry4: 1 };

    pub(super) fn plus(self, other: Self) -> Self {
        Self { levels: self.levels + other.levels, carry4: self.carry4 + other.carry4 }
    }
}
