// SPDX-License-Identifier: MIT OR Apache-2.0
//! Logic levels of the longest path, counted in the synthesized netlist.
//!
//! A path goes from a register, a memory or an input port to a register, a memory or an output port.
//! On its way a LUT is a level, an asynchronous read of distributed RAM is one, a multiplication
//! without registers is one, and a carry chain is one, however long: its blocks of four bits are
//! counted apart, because a block costs a fraction of a LUT. Multiplexers behind LUTs (MUXF7..9)
//! belong to their LUTs. Modules that were kept apart are entered, so that paths cross them.
//!
//! There are no nanoseconds in it: wires are most of the delay, and only placement knows them.

mod cell;
mod graph;
mod raw;
mod search;

use serde::{Deserialize, Serialize};

use crate::error::EstimateError;
use graph::Graph;
use raw::RawNetlist;

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
struct Weight {
    levels: u32,
    carry4: u32,
}

impl Weight {
    const NONE: Self = Self { levels: 0, carry4: 0 };
    const LEVEL: Self = Self { levels: 1, carry4: 0 };
    const CHAIN: Self = Self { levels: 1, carry4: 1 };
    const BLOCK: Self = Self { levels: 0, carry4: 1 };

    fn plus(self, other: Self) -> Self {
        Self { levels: self.levels + other.levels, carry4: self.carry4 + other.carry4 }
    }
}

/// The longest path of each of the `tops`, with all modules inside them.
///
/// # Errors
/// When the netlist is not understood, a module is missing, or logic runs in a circle.
pub(crate) fn longest_paths(
    file: &'static str,
    json: &[u8],
    tops: &[&str],
) -> Result<Vec<LogicPath>, EstimateError> {
    let netlist: RawNetlist =
        serde_json::from_slice(json).map_err(|source| EstimateError::Format { file, source })?;
    tops.iter().map(|top| search::longest(&Graph::of(&netlist, top)?)).collect()
}

#[cfg(test)]
mod tests;
