// SPDX-License-Identifier: MIT OR Apache-2.0
//! The logic levels of the longest path, counted in the synthesized netlist.
//!
//! A path leads from a register, a memory or an input port to a register, a memory or an output
//! port. Each of these is one level: a LUT, an asynchronous read of distributed RAM, a
//! multiplication without registers, and a carry chain of any length. The blocks of four bits of a
//! chain are counted separately, because a block costs a fraction of a LUT. Multiplexers behind
//! LUTs (MUXF7..9) belong to their LUTs. Paths also cross modules that were kept separate.
//!
//! The slowest path may be another one: each cell on it has the delay of Yosys' model of it, and
//! wires are a fixed share of the whole. The real delays of wires are known only after placement;
//! `docs/clock.md` states the error.

mod cell;
mod ecp5;
mod graph;
mod path;
mod path_search;
mod raw_netlist;

use crate::error::EstimateError;
use graph::NetGraph;
pub use path::LogicPath;
use path::PathWeight;
pub(crate) use path::WIRING_SHARE;
use raw_netlist::PathNetlist;

/// Returns the longest path of each of the `tops`, with all modules inside them.
///
/// # Errors
/// Fails if the netlist cannot be read, a module is missing, or there is a combinational loop.
pub(crate) fn longest_paths(
    file: &'static str,
    json: &[u8],
    tops: &[&str],
) -> Result<Vec<LogicPath>, EstimateError> {
    let netlist: PathNetlist = serde_json::from_slice(json)
        .map_err(|source| EstimateError::UnreadableFile { file, source })?;
    let longest = |top: &&str| {
        let graph = NetGraph::of(&netlist, top, CellLibrary::Xilinx)?;
        path_search::longest_path(&graph, PathWeight::by_levels).map(|(path, _)| path)
    };
    tops.iter().map(longest).collect()
}

/// Returns the slowest path of `top` with all modules inside it, and its time in picoseconds.
///
/// # Errors
/// Fails like [`longest_paths`].
pub(crate) fn slowest_path(
    file: &'static str,
    json: &[u8],
    top: &str,
    library: CellLibrary,
) -> Result<(LogicPath, u32), EstimateError> {
    let netlist: PathNetlist = serde_json::from_slice(json)
        .map_err(|source| EstimateError::UnreadableFile { file, source })?;
    path_search::longest_path(&NetGraph::of(&netlist, top, library)?, PathWeight::by_time)
}

/// The vendor library of the cells in a netlist.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CellLibrary {
    Xilinx,
    Ecp5,
}

#[cfg(test)]
mod tests;
