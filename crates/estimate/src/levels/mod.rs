// SPDX-License-Identifier: MIT OR Apache-2.0
//! Logic levels of the longest path, counted in the synthesized netlist.
//!
//! A path goes from a register, a memory or an input port to a register, a memory or an output port.
//! On its way a LUT is a level, an asynchronous read of distributed RAM is one, a multiplication
//! without registers is one, and a carry chain is one, however long: its blocks of four bits are
//! counted apart, because a block costs a fraction of a LUT. Multiplexers behind LUTs (MUXF7..9)
//! belong to their LUTs. Modules that were kept apart are entered, so that paths cross them.
//!
//! The slowest path is another one: each cell on it has the delay of Yosys' model of it, and wires are a
//! stated share of the whole. Only placement knows them; see `docs/clock.md` for how far off that is.

mod cell;
mod delay;
mod ecp5;
mod graph;
mod joint;
mod path;
mod raw;
mod search;

use crate::error::EstimateError;
use graph::Graph;
pub use path::LogicPath;
pub(crate) use path::WIRING_SHARE;
use path::Weight;
use raw::RawNetlist;

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
    let longest = |top: &&str| {
        let graph = Graph::of(&netlist, top, Library::Xilinx)?;
        search::longest(&graph, Weight::by_levels).map(|(path, _)| path)
    };
    tops.iter().map(longest).collect()
}

/// The slowest path of `top` with all modules inside it, and its time in picoseconds.
///
/// # Errors
/// As [`longest_paths`].
pub(crate) fn slowest_path(
    file: &'static str,
    json: &[u8],
    top: &str,
    library: Library,
) -> Result<(LogicPath, u32), EstimateError> {
    let netlist: RawNetlist =
        serde_json::from_slice(json).map_err(|source| EstimateError::Format { file, source })?;
    search::longest(&Graph::of(&netlist, top, library)?, Weight::by_time)
}

/// Whose cells a netlist is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Library {
    Xilinx,
    Ecp5,
}

#[cfg(test)]
mod tests;
